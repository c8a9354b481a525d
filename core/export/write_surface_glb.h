// The surface that is flattened, as a program that draws on it needs it.
#pragma once

#include <string>

#include "core/weld/surface_mesh.h"

namespace lastflat {

/// Binary glTF, in metres: vertices in the order of the file, so that an index is the id that a
/// request names; those that the mending made come last. `extras.welded_to` of the mesh is the
/// accessor that says for every vertex which one stands for it; triangles use only those.
[[nodiscard]] std::string write_surface_glb(const SurfaceMesh& surface);

}  // namespace lastflat
