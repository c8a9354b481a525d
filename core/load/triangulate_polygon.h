// Polygons to triangles.
#pragma once

#include <span>
#include <vector>

#include "core/numerics/types.h"

namespace lastflat {

/// Splits a simple polygon into triangles by ear clipping in its mean plane; the best-shaped ear
/// goes first, so a quad is cut along its shorter diagonal. A polygon without any ear (crossing
/// itself, or without area) is split as a fan. Corners that repeat their predecessor are dropped.
///
/// Out: at most corners - 2 triangles, wound as the polygon; none if fewer than three corners
/// differ.
[[nodiscard]] std::vector<Triangle> triangulate_polygon(const Points3& positions,
                                                        std::span<const Index> corners);

}  // namespace lastflat
