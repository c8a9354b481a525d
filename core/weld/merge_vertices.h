// Vertices of one position become one vertex.
#pragma once

#include "core/numerics/types.h"

namespace lastflat {

/// For every vertex the smallest id of those it is merged with: all that a chain of steps of at
/// most `tolerance_mm` reaches. Zero merges equal positions only. Between two spots, each narrower
/// than the tolerance, that hold hundreds of vertices, a step may be missed: time is bounded first.
[[nodiscard]] std::vector<Index> merge_vertices(const Points3& positions, double tolerance_mm);

/// No vertex is merged: 0, 1, 2 ...
[[nodiscard]] std::vector<Index> each_for_itself(std::size_t count);

}  // namespace lastflat
