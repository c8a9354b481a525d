// Lines on the surface between points that are near each other.
#pragma once

#include "core/locate/surface_search.h"

namespace lastflat {

/// Appends the points where the line from the last of `line` to `to` enters another face, and `to`:
/// the section of the surface with the plane through both that stands on it; between two points of
/// the border, the border. Where the section loses its way, it goes by the points of the surface
/// nearest to points between them. False: there is no such line; `line` is then unchanged.
[[nodiscard]] bool follow_surface(const SurfaceSearch& search, const SurfaceMesh& surface,
                                  const SurfacePoint& to, std::vector<SurfacePoint>& line);

}  // namespace lastflat
