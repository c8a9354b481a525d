// The first chart of a region: the whole answer of the convex combination methods, the start of
// `isometric`.
#pragma once

#include "core/error.h"
#include "core/parameterize/chart.h"
#include "core/parameterize/method.h"

namespace lastflat {

struct Start {
    Chart chart;
    std::vector<Warning> warnings;
};

/// In:     per border edge, whether its length is locked (see `flatten_geodesic_fan`).
/// Out:    for `isometric` a chart without flipped triangles: the geodesic fan or, where that folds
///         or fails, mean values on a circle, with the warning `start_replaced`.
/// Throws: Error{method_failed, solver_failed} if there is no such chart; other methods as they do.
[[nodiscard]] Start start_chart(const Region& region, const std::vector<bool>& locked_border,
                                const MethodOptions& method);

}  // namespace lastflat
