#include "core/cut/region.h"

#include <numbers>
#include <numeric>

#include "core/numerics/geometry.h"

namespace lastflat {

std::vector<std::vector<Index>> border_loops(const Region& region) {
    std::vector<std::vector<Index>> loops{region.border};
    loops.insert(loops.end(), region.holes.begin(), region.holes.end());
    return loops;
}

std::vector<bool> border_mask(const Region& region) {
    std::vector<bool> mask(region.positions.size(), false);
    for (const auto& loop : border_loops(region)) {
        for (const Index vertex : loop) mask[static_cast<std::size_t>(vertex)] = true;
    }
    return mask;
}

std::vector<double> loop_lengths(const Region& region, const std::vector<Index>& loop) {
    std::vector<double> lengths(loop.size());
    for (std::size_t i = 0; i < lengths.size(); ++i)
        lengths[i] = region.distance(loop[i], loop[(i + 1) % lengths.size()]);
    return lengths;
}

double loop_length(const Region& region, const std::vector<Index>& loop) {
    const auto lengths = loop_lengths(region, loop);
    return std::accumulate(lengths.begin(), lengths.end(), 0.0);
}

std::vector<double> border_lengths(const Region& region) {
    return loop_lengths(region, region.border);
}

std::vector<double> loop_turnings(const Region& region,
                                  const std::vector<std::vector<Index>>& loops) {
    std::vector<Index> loop_of(region.positions.size(), -1);
    std::vector<double> turnings;
    for (const auto& loop : loops) {
        for (const Index v : loop)
            loop_of[static_cast<std::size_t>(v)] = static_cast<Index>(turnings.size());
        turnings.push_back(std::numbers::pi * static_cast<double>(loop.size()));
    }
    for (const Triangle& t : region.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            const Index loop = loop_of[static_cast<std::size_t>(t[i])];
            if (loop >= 0)
                turnings[static_cast<std::size_t>(loop)] -=
                    angle_at(region.position(t[i]), region.position(t[(i + 1) % 3]),
                             region.position(t[(i + 2) % 3]));
        }
    }
    return turnings;
}

Vec3 area_vector(const Region& region) {
    Vec3 sum = Vec3::Zero();
    for (const Triangle& t : region.triangles) sum += 0.5 * doubled_area_vector(region, t);
    return sum;
}

double surface_area(const Region& region) {
    double area = 0.0;
    for (const Triangle& t : region.triangles) area += 0.5 * doubled_area_vector(region, t).norm();
    return area;
}

}  // namespace lastflat
