// Whether constraints speak of what is there.
#pragma once

#include "core/constrain/constraint.h"
#include "core/locate/curves.h"

namespace lastflat {

/// Throws: Error{curve_invalid} for a constraint on a curve, a region or a vertex that does not
///         exist, or for a pin on a vertex that several regions have; each at its field.
void check_constraints(const std::vector<Constraint>& constraints, const Curves& curves,
                       const std::vector<Region>& regions);

}  // namespace lastflat
