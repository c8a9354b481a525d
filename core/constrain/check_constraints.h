// Whether constraints speak of what is there.
#pragma once

#include "core/constrain/constraint.h"
#include "core/cut/insert_curves.h"

namespace lastflat {

/// Throws: Error{curve_invalid} for a constraint on a curve, a region or a vertex that does not
///         exist, on a curve that does not run through the region named, or for a pin on a vertex
///         that several regions have; each at its field.
void check_constraints(const std::vector<Constraint>& constraints, const Curves& curves,
                       const std::vector<Region>& regions);

/// The same for the zones of "weights".
void check_zones(const std::vector<Zone>& zones, const Curves& curves,
                 const std::vector<Region>& regions);

}  // namespace lastflat
