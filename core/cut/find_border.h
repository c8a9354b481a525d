// Where a region ends.
#pragma once

#include "core/cut/region.h"

namespace lastflat {

/// Fills in `half_edges`, `border` and `holes`: the loop that turns furthest to the left on the
/// surface (of those that turn alike, such as the ends of a tube, the one that spans the largest
/// area), and all others, in the order of their smallest vertices. Every loop begins at its
/// smallest vertex. Throws: Error{region_not_disk} if the region is closed or has handles, saying
/// where.
void find_border(Region& region);

}  // namespace lastflat
