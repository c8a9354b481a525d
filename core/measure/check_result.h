// May this result leave the house?
#pragma once

#include "core/error.h"
#include "core/measure/report.h"
#include "core/parameterize/method.h"

namespace lastflat {

/// Throws: Error{method_failed} if triangles are flipped; with `isometric` also
/// Error{border_crosses}
///         and Error{constraints_infeasible} if a lock is not kept. Other methods promise neither:
///         a border that crosses itself becomes a warning, open locks stand in the curves'
///         verdicts.
void check_result(const Region& region, const Points2& uv, MethodName method,
                  const Metrics& metrics, const std::vector<CurveReport>& curves,
                  std::vector<Warning>& warnings);

}  // namespace lastflat
