// Whether what was found on a bare last can be one.
#pragma once

#include "core/landmarks/bare_last.h"
#include "core/landmarks/landmarks.h"
#include "core/landmarks/sole_and_top.h"

namespace lastflat {

/// Holds the landmarks against each other: the sole looks down, the top lies above the heel, both
/// lines of the middle end on the topline, and lengths have the ratios of a last's.
///
/// Throws: Error{region_invalid}, saying which of these does not hold, and where.
void check_outcome(const std::vector<BareFace>& faces, const SoleAndTop& parts,
                   const Points3& featherline, const Points3& topline, const Landmarks& found);

}  // namespace lastflat
