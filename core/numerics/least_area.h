// A polygon in space, filled.
#pragma once

#include <functional>

#include "core/numerics/types.h"

namespace lastflat {

/// The triangulation of least area over the polygon's own corners [barequet-1995], which
/// avoids triangles without height. Takes the cube of the corners in time, the square in memory.
///
/// In:     at least three corners; `is_taken` says between which corners i < j no new edge may run.
/// Out:    indices of corners, wound as the polygon runs; none if there is no way.
[[nodiscard]] std::vector<Triangle> least_area_triangles(
    const Points3& polygon, const std::function<bool(std::size_t i, std::size_t j)>& is_taken);

}  // namespace lastflat
