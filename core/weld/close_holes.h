// Small holes of a surface that is closed but for them.
#pragma once

#include "core/weld/clean_faces.h"

namespace lastflat {

/// Whether the surface is open, but closed but for small holes.
[[nodiscard]] bool has_only_small_holes(const Faces& faces);

/// Closes every border loop of a surface that has none further across than
/// `tolerance::small_hole_mm`, by the triangulation of least area over the loop's own vertices
/// [barequet-1995]. A surface with a larger opening stays as it is: there a small hole
/// is opened or kept as the request says.
void close_small_holes(Faces& faces, std::vector<Repair>& repairs);

}  // namespace lastflat
