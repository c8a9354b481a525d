#include "core/load/triangulate_polygon.h"

#include <Eigen/Geometry>

#include "core/numerics/polygon.h"

namespace lastflat {
namespace {

/// Twice the polygon's area vector (Newell): its direction is the mean plane's normal.
Vec3 area_vector(const Points3& positions, const std::vector<Index>& loop) {
    const auto at = [&](std::size_t i) { return positions[static_cast<std::size_t>(loop[i])]; };
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
        sum += (at(i) - at(0)).cross(at(i + 1) - at(0));
    }
    return sum;
}

bool inside(const Vec2& p, const Vec2& a, const Vec2& b, const Vec2& c) {
    return doubled_area(a, b, p) >= 0 && doubled_area(b, c, p) >= 0 && doubled_area(c, a, p) >= 0;
}

/// The shape of the ear at corner i: the larger the better, not positive if it is no ear.
double ear_quality(const Points2& flat, const std::vector<std::size_t>& left, std::size_t i) {
    const std::size_t n = left.size();
    const std::size_t before = left[(i + n - 1) % n], here = left[i], after = left[(i + 1) % n];
    const Vec2 &a = flat[before], &b = flat[here], &c = flat[after];
    const double area = doubled_area(a, b, c);
    if (area <= 0.0) return 0.0;
    for (const std::size_t other : left) {
        if (other != before && other != here && other != after && inside(flat[other], a, b, c)) {
            return 0.0;
        }
    }
    return area / (c - a).squaredNorm();  // height over the cut: large for short diagonals
}

}  // namespace

std::vector<Triangle> triangulate_polygon(const Points3& positions,
                                          std::span<const Index> corners) {
    std::vector<Index> loop;
    for (const Index corner : corners) {
        if (loop.empty() || loop.back() != corner) loop.push_back(corner);
    }
    while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
    if (loop.size() < 3) return {};
    if (loop.size() == 3) return {{loop[0], loop[1], loop[2]}};

    const Vec3 normal = area_vector(positions, loop).normalized();
    const Vec3 x = normal.unitOrthogonal();
    const Vec3 y = normal.cross(x);
    Points2 flat;
    std::vector<std::size_t> left;
    for (const Index corner : loop) {
        const Vec3 p = positions[static_cast<std::size_t>(corner)] -
                       positions[static_cast<std::size_t>(loop[0])];
        left.push_back(flat.size());
        flat.emplace_back(p.dot(x), p.dot(y));
    }
    std::vector<Triangle> triangles;
    while (left.size() > 2) {
        std::size_t ear = 0;
        double best = 0.0;
        for (std::size_t i = 0; i < left.size(); ++i) {
            const double quality = ear_quality(flat, left, i);
            if (quality > best) {
                best = quality;
                ear = i;
            }
            if (best > 0.0 && left.size() > 64) break;  // any ear will do in very large polygons
        }
        const std::size_t n = left.size();
        triangles.push_back(
            {loop[left[(ear + n - 1) % n]], loop[left[ear]], loop[left[(ear + 1) % n]]});
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    return triangles;
}

}  // namespace lastflat
