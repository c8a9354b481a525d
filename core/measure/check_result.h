// May this result leave the house?
#pragma once

#include "core/error.h"
#include "core/measure/report.h"
#include "core/request.h"

namespace lastflat {

/// Throws: Error{method_failed} if triangles are flipped; with `isometric` also
///         Error{border_crosses}. Other methods do not promise that: a border that crosses itself
///         becomes a warning.
void check_result(const Region& region, const Points2& uv, MethodName method,
                  const Metrics& metrics, std::vector<Warning>& warnings);

/// Throws: Error{constraints_infeasible} if a constraint is not kept; one that was relaxed becomes
///         the warning `constraint_relaxed`.
void check_constraints_kept(const std::vector<ConstraintReport>& reports,
                            const std::vector<Constraint>& constraints,
                            std::vector<Warning>& warnings);

}  // namespace lastflat
