// The disk that a region with holes is a part of.
#pragma once

#include "core/cut/region.h"

namespace lastflat {

/// The region, its vertices and triangles first, and over every hole a cone: one more vertex in the
/// middle, raised a little, so that even a slit, a hole without area, is closed by triangles that
/// have some. A map of the disk without flipped triangles is one of the region, whose holes open.
///
/// Out:    a disk; no runs; the added vertices have the source -1.
[[nodiscard]] Region with_holes_filled(const Region& region);

}  // namespace lastflat
