#include "core/weld/sides.h"

#include <algorithm>

namespace lastflat {

std::vector<Side> sides_by_edge(const std::vector<Triangle>& triangles) {
    std::vector<Side> sides;
    sides.reserve(3 * triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        for (std::size_t i = 0; i < 3; ++i) {
            const Index a = triangles[t][i], b = triangles[t][(i + 1) % 3];
            sides.push_back({std::min(a, b), std::max(a, b), static_cast<Index>(t),
                             static_cast<Index>(i), a < b});
        }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& x, const Side& y) {
        if (x.low != y.low) return x.low < y.low;
        if (x.high != y.high) return x.high < y.high;
        return x.triangle < y.triangle;
    });
    return sides;
}

}  // namespace lastflat
