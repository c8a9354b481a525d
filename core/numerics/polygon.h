// Closed polygons in the plane.
#pragma once

#include "core/numerics/geometry.h"

namespace lastflat {

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

}  // namespace lastflat
