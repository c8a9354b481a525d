#include "core/numerics/least_area.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace lastflat {
namespace {

/// What a triangle costs: twice its area, and much more if it has hardly any height.
double cost(const Vec3& a, const Vec3& b, const Vec3& c) {
    constexpr double least_height = 1e-3;  // of the longest side
    const double area = (b - a).cross(c - a).norm();
    const double longest =
        std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    return area < least_height * longest ? area + longest : area;
}

}  // namespace

std::vector<Triangle> least_area_triangles(
    const Points3& polygon, const std::function<bool(std::size_t i, std::size_t j)>& is_taken) {
    const std::size_t n = polygon.size();
    // For the part of the polygon between corners i and j: the least cost, and the third corner of
    // the triangle over their side.
    std::vector<double> least(n * n, 0.0);
    std::vector<std::size_t> third(n * n, 0);
    for (std::size_t span = 2; span < n; ++span) {
        for (std::size_t i = 0, j = span; j < n; ++i, ++j) {
            double& best = least[i * n + j];
            best = std::numeric_limits<double>::infinity();
            if (j - i < n - 1 && is_taken(i, j)) continue;
            for (std::size_t k = i + 1; k < j; ++k) {
                const double parts = least[i * n + k] + least[k * n + j];
                if (parts >= best) continue;
                const double whole = parts + cost(polygon[i], polygon[k], polygon[j]);
                if (whole >= best) continue;
                best = whole;
                third[i * n + j] = k;
            }
        }
    }
    std::vector<Triangle> triangles;
    if (least[n - 1] == std::numeric_limits<double>::infinity()) return triangles;
    std::vector<std::pair<std::size_t, std::size_t>> open{{0, n - 1}};
    while (!open.empty()) {
        const auto [i, j] = open.back();
        open.pop_back();
        if (j - i < 2) continue;
        const std::size_t k = third[i * n + j];
        triangles.push_back({static_cast<Index>(i), static_cast<Index>(k), static_cast<Index>(j)});
        open.emplace_back(i, k);
        open.emplace_back(k, j);
    }
    return triangles;
}

}  // namespace lastflat
