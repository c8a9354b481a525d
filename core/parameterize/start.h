// The first chart of a region: the whole answer of the convex combination methods, the start of
// those that minimise an energy.
#pragma once

#include "core/error.h"
#include "core/parameterize/chart.h"
#include "core/request.h"

namespace lastflat {

struct Start {
    Chart chart;
    std::vector<Warning> warnings;
};

/// Of a region with holes it is a part of the chart of the disk that has them filled.
///
/// In:     per edge of the outer loop, whether its length is locked (see `border_polygon`).
/// Out:    for the energies a chart without flipped triangles: the geodesic fan or, where that
///         folds, fails or crosses its own border, the region seen along its mean normal, or mean
///         values on a circle, with the warning `start_replaced`. For harmonic
///         and wachspress the warning `negative_weights` where there are such weights: the map may
///         then fold.
/// Throws: Error{method_failed, solver_failed} if there is no such chart; other methods as they do.
[[nodiscard]] Start start_chart(const Region& region, const std::vector<bool>& locked_border,
                                const MethodOptions& method);

}  // namespace lastflat
