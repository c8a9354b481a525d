// Convex combination maps whose border takes a shape of its own, behind a virtual layer.
#pragma once

#include "core/border/border_polygon.h"
#include "core/parameterize/chart.h"
#include "core/parameterize/weights.h"

namespace lastflat {

/// Flattens a region so that its border floats: one virtual layer around the hull of the border's
/// polygon is held fixed, and every vertex of the region, border included, is a combination of its
/// neighbours. With mean value weights and locked edges kept by the polygon this is the paper's
/// method, the geodesic fan.
///
/// Paper:  [kim-kim], section 3; the layer: [lee-2002].
/// In:     a region, the elimination order of its half-edges; the border's polygon.
/// Out:    not yet scaled: the layer's tension changes lengths by a few percent.
/// Throws: Error{method_failed} if the polygon winds around itself; Error{solver_failed}.
[[nodiscard]] Chart flatten_floating_border(const Region& region, const Dissection& dissection,
                                            WeightRule weights, const BorderPolygon& polygon);

}  // namespace lastflat
