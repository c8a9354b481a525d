#include "core/cut/region.h"

#include <Eigen/Geometry>

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

std::vector<double> border_lengths(const Region& region) {
    return loop_lengths(region, region.border);
}

Vec3 area_vector(const Region& region) {
    Vec3 sum = Vec3::Zero();
    for (const Triangle& t : region.triangles) {
        sum += 0.5 * (region.position(t[1]) - region.position(t[0]))
                         .cross(region.position(t[2]) - region.position(t[0]));
    }
    return sum;
}

double surface_area(const Region& region) {
    double area = 0.0;
    for (const Triangle& t : region.triangles) {
        area += 0.5 * (region.position(t[1]) - region.position(t[0]))
                          .cross(region.position(t[2]) - region.position(t[0]))
                          .norm();
    }
    return area;
}

}  // namespace lastflat
