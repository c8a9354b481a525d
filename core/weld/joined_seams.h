// What the joining of coincident vertices closed.
#pragma once

#include "core/weld/clean_faces.h"

namespace lastflat {

/// Lists the slits that are none any more: the lines of edges that were on the border while the
/// triangles had the vertices `before`, and are inside now, each with its middle and its length.
void list_joined_seams(const std::vector<Triangle>& before, const Faces& faces,
                       std::vector<Repair>& repairs);

}  // namespace lastflat
