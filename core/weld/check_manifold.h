// Is a set of triangles a surface?
#pragma once

#include "core/weld/sides.h"

namespace lastflat {

/// `sides`: those of the triangles.
/// Throws: Error{mesh_not_manifold, mesh_not_oriented} with the first position, if an edge has more
///         than two triangles, two triangles wind against each other, or the triangles around a
///         vertex form more than one fan.
void check_manifold(const Points3& positions, const std::vector<Triangle>& triangles,
                    const std::vector<Side>& sides);

/// Whether every edge has two triangles that wind alike.
[[nodiscard]] bool is_closed(const std::vector<Side>& sides);

}  // namespace lastflat
