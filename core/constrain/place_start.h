// Where a search begins.
#pragma once

#include "core/constrain/constraint_rows.h"

namespace lastflat {

/// The starts as coordinates, each scaled to its surface's area.
///
/// Throws: Error{method_failed} if a start is folded.
[[nodiscard]] Eigen::VectorXd scaled_starts(const Domain& domain, const std::vector<Chart>& starts);

/// The charts turned and moved to the pins among the rows: a rigid motion costs nothing, so the
/// pins need not pull them there.
[[nodiscard]] Eigen::VectorXd moved_to_pins(const Domain& domain,
                                            const std::vector<ConstraintRow>& rows,
                                            const Eigen::VectorXd& x);

}  // namespace lastflat
