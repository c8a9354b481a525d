// Closed polygons in the plane and triangles in space: the elementary measures.
#pragma once

#include <vector>

#include "core/numerics/types.h"

namespace lastflat {

[[nodiscard]] inline double cross(const Vec2& a, const Vec2& b) {
    return a.x() * b.y() - a.y() * b.x();
}

/// Twice the signed area of a triangle, positive if counter-clockwise.
[[nodiscard]] inline double doubled_area(const Vec2& a, const Vec2& b, const Vec2& c) {
    return cross(b - a, c - a);
}

/// Signed area, positive if counter-clockwise.
[[nodiscard]] double signed_area(const Points2& polygon);

/// Convex hull (Andrew's monotone chain): indices of its strict corners, counter-clockwise.
[[nodiscard]] std::vector<Index> convex_hull(const Points2& points);

/// A pair of polygon edges that meet although they are not neighbours; edge i runs from point i
/// to its successor.
struct Crossing {
    Index a, b;
};

/// All pairs of edges of a closed polygon that cross or touch without being neighbours, in
/// ascending order. Candidates come from a sort along x, so typical outlines take n log n.
[[nodiscard]] std::vector<Crossing> self_crossings(const Points2& polygon);

/// The angle at `apex` between the directions to `a` and `b`, in [0, pi].
template <class Vec>
[[nodiscard]] double angle_at(const Vec& apex, const Vec& a, const Vec& b);

}  // namespace lastflat

#include <algorithm>
#include <cmath>

template <class Vec>
double lastflat::angle_at(const Vec& apex, const Vec& a, const Vec& b) {
    // Kahan's formula: exact to the last digits for needles as well.
    const Vec p = (a - apex).normalized();
    const Vec q = (b - apex).normalized();
    return 2.0 * std::atan2((p - q).norm(), (p + q).norm());
}
