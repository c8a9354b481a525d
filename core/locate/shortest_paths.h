// Curves that are shortest paths between points.
#pragma once

#include "core/locate/surface_point.h"

namespace lastflat {

/// The line through the points in their order, a shortest path of the surface between each two.
/// Throws: Error{solver_failed} of `ExactGeodesics` and `trace_path`; Error{curve_invalid} if two
///         consecutive points lie on pieces that do not meet.
[[nodiscard]] std::vector<SurfacePoint> shortest_paths(const SurfaceMesh& surface,
                                                       const std::vector<SurfacePoint>& through);

}  // namespace lastflat
