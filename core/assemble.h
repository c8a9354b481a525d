// From charts to the result: laid on the sheet, measured, certified.
#pragma once

#include "core/result.h"
#include "core/solve.h"

namespace lastflat {

/// The charts laid on the sheet, measured and found sound. Its `timing` is left to the caller.
/// Throws: Error, as `check_result`, `check_constraints_kept`.
[[nodiscard]] FlattenResult assembled(Prepared prepared, Solution solution,
                                      const FlattenOptions& options);

}  // namespace lastflat
