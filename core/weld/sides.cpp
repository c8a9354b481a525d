#include "core/weld/sides.h"

#include <algorithm>

namespace lastflat {
namespace {

Index vertex_count(const std::vector<Triangle>& triangles) {
    Index count = 0;
    for (const Triangle& t : triangles) count = std::max({count, t[0] + 1, t[1] + 1, t[2] + 1});
    return count;
}

}  // namespace

std::vector<Side> sides_by_edge(const std::vector<Triangle>& triangles) {
    std::vector<std::size_t> begin(at(vertex_count(triangles)) + 1, 0);  // of each low vertex
    const auto for_each_side = [&](const auto& visit) {
        for (std::size_t t = 0; t < triangles.size(); ++t) {
            for (std::size_t i = 0; i < 3; ++i) {
                const Index a = triangles[t][i], b = triangles[t][(i + 1) % 3];
                visit(Side{std::min(a, b), std::max(a, b), static_cast<Index>(t),
                           static_cast<Index>(i), a < b});
            }
        }
    };
    for_each_side([&](const Side& side) { ++begin[at(side.low) + 1]; });
    for (std::size_t v = 1; v < begin.size(); ++v) begin[v] += begin[v - 1];
    std::vector<Side> sides(3 * triangles.size());
    std::vector<std::size_t> next = begin;
    for_each_side([&](const Side& side) { sides[next[at(side.low)]++] = side; });
    for (std::size_t v = 0; v + 1 < begin.size(); ++v) {
        std::sort(sides.begin() + static_cast<std::ptrdiff_t>(begin[v]),
                  sides.begin() + static_cast<std::ptrdiff_t>(begin[v + 1]),
                  [](const Side& x, const Side& y) {
                      if (x.high != y.high) return x.high < y.high;
                      return x.triangle != y.triangle ? x.triangle < y.triangle
                                                      : x.corner < y.corner;
                  });
    }
    return sides;
}

DisjointSets patches_of(const std::vector<Triangle>& triangles, const std::vector<Side>& sides) {
    DisjointSets patches(triangles.size());
    for_each_edge(sides, [&](auto first, auto last) {
        if (last - first == 2 && first->forward != (first + 1)->forward)
            patches.join(first->triangle, (first + 1)->triangle);
    });
    return patches;
}

}  // namespace lastflat
