// Where a function on a piece is at least so large.
#pragma once

#include <vector>

#include "core/cut/region.h"

namespace lastflat {

/// The outlines of where the function that is linear on every triangle, with these values at the
/// vertices, is at least `level`: closed loops with that place on their left, as `positions` has
/// it; filled by the even-odd rule they are it. A vertex at the level lies in it.
[[nodiscard]] std::vector<Points2> super_level_loops(const Region& region, const Points2& positions,
                                                     const std::vector<double>& values,
                                                     double level);

}  // namespace lastflat
