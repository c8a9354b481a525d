// Is a region a disk?
#pragma once

#include "core/cut/region.h"

namespace lastflat {

/// The border loop of a disk, counter-clockwise seen from outside, from its smallest vertex.
/// Throws: Error{region_not_disk} saying what the region is instead, with a place on each loop.
[[nodiscard]] std::vector<Index> checked_border(const Region& region);

}  // namespace lastflat
