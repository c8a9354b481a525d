#include "core/cut/region.h"

#include <Eigen/Geometry>

namespace lastflat {

std::vector<bool> border_mask(const Region& region) {
    std::vector<bool> mask(region.positions.size(), false);
    for (const Index vertex : region.border) mask[static_cast<std::size_t>(vertex)] = true;
    return mask;
}

std::vector<double> border_lengths(const Region& region) {
    std::vector<double> lengths(region.border.size());
    for (std::size_t i = 0; i < lengths.size(); ++i) {
        lengths[i] = region.distance(region.border[i], region.border[(i + 1) % lengths.size()]);
    }
    return lengths;
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
