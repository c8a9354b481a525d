// What of the surface no region takes.
#pragma once

#include "core/cut/cut.h"
#include "core/cut/insert_curves.h"

namespace lastflat {

/// One warning `piece_left_out` for each piece that the cuts leave and no region is, the largest
/// first, ten at most. What nothing but `featherline` and `topline` part from the rest, a sole or a
/// top, is no piece of an upper and is not told.
///
/// In: the surface with the curves put in, as it was cut; names of the curves along which it was.
[[nodiscard]] std::vector<Warning> left_out_pieces(const SurfaceMesh& surface, const Curves& curves,
                                                   const std::vector<std::string>& cuts,
                                                   const std::vector<Region>& regions);

}  // namespace lastflat
