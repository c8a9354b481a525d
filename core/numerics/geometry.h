// Vectors, segments and triangles, in the plane and in space: the elementary measures.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/numerics/types.h"

namespace lastflat {

[[nodiscard]] inline double cross(const Vec2& a, const Vec2& b) {
    return a.x() * b.y() - a.y() * b.x();
}

/// Twice the signed area of a triangle, positive if counter-clockwise.
[[nodiscard]] inline double doubled_area(const Vec2& a, const Vec2& b, const Vec2& c) {
    return cross(b - a, c - a);
}

/// Of a triangle of the surface: its normal, as long as twice its area.
template <class Surface>
[[nodiscard]] Vec3 doubled_area_vector(const Surface& surface, const Triangle& t) {
    const auto& origin = surface.position(t[0]);
    return (surface.position(t[1]) - origin).cross(surface.position(t[2]) - origin);
}

template <class Surface>
[[nodiscard]] Vec3 centroid(const Surface& surface, const Triangle& t) {
    return (surface.position(t[0]) + surface.position(t[1]) + surface.position(t[2])) / 3.0;
}

/// Of a triangle of the surface: its smallest height as a share of its longest side; no number if
/// it has none.
template <class Surface>
[[nodiscard]] double height_share(const Surface& surface, const Triangle& t) {
    double longest = 0.0;
    for (std::size_t i = 0; i < 3; ++i)
        longest = std::max(
            longest, (surface.position(t[(i + 1) % 3]) - surface.position(t[i])).squaredNorm());
    return doubled_area_vector(surface, t).norm() / longest;
}

/// From a to b, counter-clockwise, in [-pi, pi].
[[nodiscard]] inline double signed_angle(const Vec2& a, const Vec2& b) {
    return std::atan2(cross(a, b), a.dot(b));
}

/// In [0, pi].
[[nodiscard]] inline double angle_between(const Vec3& a, const Vec3& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// The angle at `apex` between the directions to `a` and `b`, in [0, pi].
template <class Vec>
[[nodiscard]] double angle_at(const Vec& apex, const Vec& a, const Vec& b) {
    // Kahan's formula: exact to the last digits for needles as well.
    const Vec p = (a - apex).normalized();
    const Vec q = (b - apex).normalized();
    return 2.0 * std::atan2((p - q).norm(), (p + q).norm());
}

/// Where on the way from one point to another the one nearest to `p` lies: 0 to 1; 0 if both are
/// one.
[[nodiscard]] inline double nearest_share(const Vec3& from, const Vec3& to, const Vec3& p) {
    const Vec3 way = to - from;
    const double square = way.squaredNorm();
    return square > 0.0 ? std::clamp(way.dot(p - from) / square, 0.0, 1.0) : 0.0;
}

[[nodiscard]] inline double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
    return (a + nearest_share(a, b, p) * (b - a) - p).norm();
}

[[nodiscard]] inline double length_of(const Points3& line) {
    double length = 0.0;
    for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
    return length;
}

/// In: at least one point.
[[nodiscard]] inline double distance_to_line(const Points3& line, const Vec3& p) {
    double least = (line.front() - p).norm();
    for (std::size_t i = 1; i < line.size(); ++i)
        least = std::min(least, distance_to_segment(p, line[i - 1], line[i]));
    return least;
}

/// A triangle laid into the plane: its first corner at the origin, the second along +x, the third
/// above.
struct FlatTriangle {
    double length;  ///< of the first side
    Vec2 apex;      ///< the third corner

    /// At the first corner.
    [[nodiscard]] double angle() const { return std::atan2(apex.y(), apex.x()); }
};

[[nodiscard]] inline FlatTriangle laid_flat(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 along = b - a, across = c - a;
    const double length = along.norm();
    return {length, {along.dot(across) / length, along.cross(across).norm() / length}};
}

}  // namespace lastflat
