// Faces too many at an edge.
#pragma once

#include <optional>

#include "core/error.h"
#include "core/weld/clean_faces.h"

namespace lastflat {

/// Drops fins: patches with a border of their own and less than `tolerance::stray_area` of the
/// largest one's area that end at an edge of an odd number of faces, where they are the face too
/// many.
void drop_fins(Faces& faces, std::vector<Repair>& repairs);

/// What `check_manifold` would say of the first edge at which `split_fans` will leave a border: one
/// of an odd number of faces or of two that wind in opposite directions. Only if mending closes the
/// surface all the same was it rightly parted there.
[[nodiscard]] std::optional<Error> edge_to_part(const Faces& faces);

}  // namespace lastflat
