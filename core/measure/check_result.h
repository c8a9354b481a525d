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

/// A pattern that no leather follows: the mean energy is above 1.02, or a hundredth of the surface
/// strains by more than 25 %, of what is known to lie behind a last's toe by more than 12 %. Such a
/// result of `isometric` gets the warning `distortion_extreme`
/// with its likely cause and the worst position.
/// Throws: Error{distortion_extreme} instead, if nobody said how the last is cut (`was_found`).
void check_distortion(const Region& region, const Metrics& metrics, const StretchReport& stretch,
                      bool was_found, std::vector<Warning>& warnings);

/// Throws: Error{constraints_infeasible} if a constraint is not kept; one that was relaxed becomes
///         the warning `constraint_relaxed`.
void check_constraints_kept(const std::vector<ConstraintReport>& reports,
                            const std::vector<Constraint>& constraints,
                            std::vector<Warning>& warnings);

}  // namespace lastflat
