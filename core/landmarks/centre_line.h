// The line over the instep, and the one down the heel: the last's section in its middle.
#pragma once

#include "core/landmarks/landmarks.h"

namespace lastflat {

/// Adds the curves `centre_front` and `heel`: the upper's section with the plane through heel
/// point, toe point and the topline's front (back).
///
/// In:    per face, whether it is of the upper; the topline as the border of its faces; whether the
///        found lines follow the faces' borders, but at bridges. `found` has featherline, topline,
///        heel and toe point, and forward.
/// Out:   `is_exact`: the section itself, from line to line; else it may go a little beyond them.
/// Throws: Error{region_invalid} if the plane does not meet the upper.
void find_centre_line(const SurfaceMesh& surface, const std::vector<bool>& upper,
                      const Points3& topline, bool is_exact, Landmarks& found);

}  // namespace lastflat
