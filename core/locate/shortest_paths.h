// Curves that are shortest paths between points.
#pragma once

#include "core/locate/surface_place.h"

namespace lastflat {

/// The line through the places in their order, a shortest path of the surface between each two.
/// Throws: Error{solver_failed} of `ExactGeodesics` and `trace_path`; Error{curve_invalid} if two
///         consecutive places lie on pieces that do not meet.
[[nodiscard]] std::vector<SurfacePlace> shortest_paths(const SurfaceMesh& surface,
                                                       const std::vector<SurfacePlace>& through);

}  // namespace lastflat
