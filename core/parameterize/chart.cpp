#include "core/parameterize/chart.h"

#include <algorithm>

#include "core/numerics/polygon.h"

namespace lastflat {
namespace {

double doubled_area_of(const Triangle& t, const Points2& uv) {
    return doubled_area(uv[static_cast<std::size_t>(t[0])], uv[static_cast<std::size_t>(t[1])],
                        uv[static_cast<std::size_t>(t[2])]);
}

}  // namespace

std::vector<Index> flipped_triangles(const Region& region, const Points2& uv) {
    std::vector<Index> flipped;
    for (std::size_t t = 0; t < region.triangles.size(); ++t) {
        // Negated, so that a point that is not a number counts as a flip.
        if (!(doubled_area_of(region.triangles[t], uv) > 0.0))
            flipped.push_back(static_cast<Index>(t));
    }
    return flipped;
}

std::vector<Triangle> source_triangles(const Region& region, const std::vector<Index>& triangles) {
    constexpr std::size_t most = 1000;
    std::vector<Triangle> result;
    for (std::size_t i = 0; i < std::min(most, triangles.size()); ++i) {
        Triangle t = region.triangles[static_cast<std::size_t>(triangles[i])];
        for (Index& v : t) v = region.source_vertices[static_cast<std::size_t>(v)];
        result.push_back(t);
    }
    return result;
}

Points2 flat_loop(const std::vector<Index>& loop, const Points2& uv) {
    Points2 outline;
    outline.reserve(loop.size());
    for (const Index v : loop) outline.push_back(uv[static_cast<std::size_t>(v)]);
    return outline;
}

std::vector<BorderCrossing> border_crossings(const Region& region, const Points2& uv) {
    std::vector<BorderCrossing> crossings;
    const auto loops = border_loops(region);
    for (const auto& loop : loops) {
        const Points2 line = flat_loop(loop, uv);
        const auto position = [&](Index i) {
            return region.position(loop[static_cast<std::size_t>(i)]);
        };
        const auto found = self_crossings(line);
        for (const Crossing& crossing : found)
            crossings.push_back({position(crossing.a), position(crossing.b)});
        const bool is_hole = &loop != &loops.front();
        if (found.empty() && (signed_area(line) > 0.0) == is_hole)
            crossings.push_back({position(0), position(static_cast<Index>(loop.size() / 2))});
    }
    return crossings;
}

double flat_area(const Region& region, const Points2& uv) {
    double area = 0.0;
    for (const Triangle& t : region.triangles) area += 0.5 * doubled_area_of(t, uv);
    return area;
}

}  // namespace lastflat
