// Lines on the surface between places that are near each other.
#pragma once

#include "core/locate/surface_search.h"

namespace lastflat {

/// Appends the places where the line from the last of `line` to `to` enters another face, and `to`:
/// the section of the surface with the plane through both that stands on it; between two places of
/// the border, the border. Where the section loses its way, it goes by the places nearest to points
/// between them. False: there is no such line; `line` is then unchanged.
[[nodiscard]] bool follow_surface(const SurfaceSearch& search, const SurfaceMesh& surface,
                                  const SurfacePlace& to, std::vector<SurfacePlace>& line);

}  // namespace lastflat
