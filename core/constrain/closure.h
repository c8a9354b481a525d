// Contradictions that lengths alone show, before anything is solved.
#pragma once

#include <optional>

#include "core/constrain/constraint_rows.h"

namespace lastflat {

struct OpenLoop {
    std::vector<std::size_t> constraints;  ///< that cannot all hold, ascending
    double gap_mm;
    Vec3 position;    ///< on the last
    std::string why;  ///< "the locked edges around 1 2 3 leave a gap of 12 degrees"
};

/// The first loop that the rows cannot close:
/// - two vertices pinned to one point;
/// - a vertex whose neighbouring edges are all locked, with angles that do not add up to a turn;
/// - a straight side of the border longer than all other sides may be;
/// - an area larger than any border of that length encloses (the isoperimetric inequality).
///
/// Only what the rows imply exactly is reported; no answer does not mean that they can hold.
[[nodiscard]] std::optional<OpenLoop> open_loop(const Domain& domain,
                                                const std::vector<ConstraintRow>& rows,
                                                const std::vector<Constraint>& constraints);

}  // namespace lastflat
