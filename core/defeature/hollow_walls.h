// Faces that can be no part of a last's own form.
#pragma once

#include "core/landmarks/bare_last.h"

namespace lastflat {

/// Faces that are hollow along one of their edges, more than a last is anywhere, and that stand
/// across the surface around them (as the foot of a nail does) or among faces that look every way
/// (as in a drilled hole); those near to each other together.
///
/// In: faces whose normals are free of noise.
[[nodiscard]] std::vector<std::vector<Index>> hollow_walls(const SurfaceMesh& surface,
                                                           const std::vector<BareFace>& faces);

}  // namespace lastflat
