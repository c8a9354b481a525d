// Convex combination maps with a fixed border.
#pragma once

#include "core/parameterize/chart.h"
#include "core/parameterize/weights.h"

namespace lastflat {

/// Flattens a region with its border held fixed.
///
/// Paper:  [floater-1997] (the embedding); the weights' own.
/// In:     a region; the 2D position of each border vertex, in the order of `region.border`,
///         counter-clockwise.
/// Out:    if the weights are positive and the border is strictly convex, no triangle flips (up to
///         round-off in regions that shrink beyond the digits of a double).
/// Throws: Error{solver_failed}.
[[nodiscard]] Chart flatten_fixed_border(const Region& region, WeightRule weights,
                                         const Points2& border);

}  // namespace lastflat
