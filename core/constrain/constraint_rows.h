// Constraints as rows of the optimiser.
#pragma once

#include "core/constrain/constraint.h"
#include "core/optimize/row.h"
#include "core/optimize/wire_stiffness.h"

namespace lastflat {

/// A row that a constraint puts on the points.
struct ConstraintRow : Row {
    std::size_t constraint;  ///< its index in the list of constraints
};

/// The rows that the constraints put on a domain. A match binds the domain that has both its sides.
[[nodiscard]] std::vector<ConstraintRow> constraint_rows(
    const Domain& domain, const std::vector<Constraint>& constraints);

/// The curves of a domain that are locked by edges: they are stiff.
[[nodiscard]] std::vector<Wire> locked_wires(const Domain& domain,
                                             const std::vector<Constraint>& constraints);

/// Of the chosen rows those that say something new, ascending: an edge that two of them lock is
/// locked once; a sum or a difference of lengths that follows from others adds nothing.
[[nodiscard]] std::vector<std::size_t> distinct_rows(const std::vector<ConstraintRow>& rows,
                                                     const std::vector<std::size_t>& chosen);

/// Which regions have to be flattened together because constraints match their curves or sew them:
/// groups of indices into `regions`, ascending.
/// Throws: Error{curve_invalid} if a match names no two sides, or a seam has them nowhere.
[[nodiscard]] std::vector<std::vector<std::size_t>> coupled_regions(
    const std::vector<Region>& regions, const std::vector<Constraint>& constraints);

}  // namespace lastflat
