// One uniform scale for methods that cannot keep single lengths.
#pragma once

#include "core/constrain/constraint.h"
#include "core/parameterize/chart.h"

namespace lastflat {

/// Scales the chart so that the locked curves together have their 3D length; without locks in this
/// region, so that the flat area is the surface's.
///
/// Paper: [kim-kim], section 3 ("lastly, we rescale"), which gives no formula.
[[nodiscard]] Chart scaled_to_locks(const Region& region, Chart chart,
                                    const std::vector<Constraint>& constraints);

}  // namespace lastflat
