// Where the named curves run in a region.
#pragma once

#include "core/cut/insert_curves.h"
#include "core/cut/region.h"

namespace lastflat {

/// Every curve's longest stretches along edges of the region, in the order of the curves and,
/// within one, along it. A run on the border follows one side of the cut only.
[[nodiscard]] std::vector<CurveRun> curve_runs(const Region& region, const Curves& curves);

}  // namespace lastflat
