// Is a set of triangles a surface?
#pragma once

#include "core/numerics/types.h"

namespace lastflat {

/// Throws: Error{mesh_not_manifold, mesh_not_oriented} with the first position, if an edge has more
///         than two triangles, two triangles wind against each other, or the triangles around a
///         vertex form more than one fan.
void check_manifold(const Points3& positions, const std::vector<Triangle>& triangles);

/// Whether every edge has two triangles that wind alike.
[[nodiscard]] bool is_closed(const std::vector<Triangle>& triangles);

}  // namespace lastflat
