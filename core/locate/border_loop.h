// The border loop at a point.
#pragma once

#include "core/locate/curves.h"

namespace lastflat {

/// The loop of the surface's border that passes through a vertex or nearest to a point. Vertices in
/// order, the surface on their left; begins and ends at the smallest id. Throws:
/// Error{curve_invalid} if there is none, or none near enough.
[[nodiscard]] std::vector<Index> border_loop(const SurfaceMesh& surface, const std::string& curve,
                                             const BorderAt& border);

}  // namespace lastflat
