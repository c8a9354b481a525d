// Closed shells inside another one: the inner wall of a hollow print, a thimble, a bolt.
#pragma once

#include "core/weld/clean_faces.h"

namespace lastflat {

/// Of a closed surface of several pieces, drops those that lie inside the largest: its outside is
/// the last.
void drop_inner_shells(Faces& faces, std::vector<Repair>& repairs);

}  // namespace lastflat
