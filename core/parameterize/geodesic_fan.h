// The paper's map: a floating border behind a virtual layer, and mean value coordinates.
#pragma once

#include "core/border/border_angles.h"
#include "core/parameterize/chart.h"

namespace lastflat {

/// Flattens a region so that its border takes a shape of its own.
///
/// Paper:  [kim-kim], section 3: border angles, edge tweaking with locked edges, convex hull, one
///         virtual layer around it [lee-2002], mean value coordinates for inside and border.
/// In:     a region; per border edge, whether its length is locked while the polygon is closed.
/// Out:    not yet scaled: the layer's tension changes lengths by a few percent.
/// Throws: Error{method_failed} naming the curve if the polygon cannot be closed;
///         Error{solver_failed}.
[[nodiscard]] Chart flatten_geodesic_fan(const Region& region, const std::vector<bool>& locked,
                                         AngleRule rule);

}  // namespace lastflat
