// The normals of a rough surface as they would be without its roughness.
#pragma once

#include "core/landmarks/bare_last.h"

namespace lastflat {

/// Radians: half of the edges, by length, bend less. What is sharp stands out from it.
[[nodiscard]] double typical_bend(const SurfaceMesh& surface, const std::vector<BareFace>& faces);

/// Radians: what bends by so much more than the surface does typically is an edge to cut along.
[[nodiscard]] double sharp_bend(const SurfaceMesh& surface, const std::vector<BareFace>& faces);

/// Takes the noise of a scan out of the normals and leaves the sharp edges: each normal becomes the
/// mean of those around it, which count the less the more their guides differ (the mean normals of
/// the evenest neighbourhoods), until what is left is as even as a last. A surface without noise
/// keeps its normals. Whether there was noise.
///
/// Paper: [zhang-2015].
bool smooth_normals(const SurfaceMesh& surface, std::vector<BareFace>& faces);

}  // namespace lastflat
