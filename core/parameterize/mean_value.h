// Mean value coordinates with a fixed border.
#pragma once

#include "core/parameterize/chart.h"

namespace lastflat {

/// Flattens a region with its border held fixed, by mean value coordinates.
///
/// Paper:  [floater-2003], section 2 (the weights); [floater-1997] (the embedding).
/// In:     a region; the 2D place of each border vertex, in the order of `region.border`,
///         counter-clockwise.
/// Out:    if the border is strictly convex, no triangle flips (up to round-off in regions that
///         shrink beyond the digits of a double).
/// Throws: Error{solver_failed}.
[[nodiscard]] Chart flatten_mean_value(const Region& region, const Points2& border);

}  // namespace lastflat
