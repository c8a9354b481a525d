// The border as a closed flat polygon that resembles it.
#pragma once

#include "core/border/border_angles.h"

namespace lastflat {

struct BorderPolygon {
    Points2 points;       ///< one per border vertex, mm
    BorderAngles angles;  ///< that its corners have
};

/// The polygon of the border's flat angles, closed by edge tweaking.
///
/// Paper:  [kim-kim], section 3.3.
/// In:     per border edge, whether its length is locked while the polygon is closed.
/// Throws: Error{method_failed} naming the curve if the polygon cannot be closed;
///         Error{solver_failed}.
[[nodiscard]] BorderPolygon border_polygon(const Region& region, const Dissection& dissection,
                                           const std::vector<bool>& locked, AngleRule rule);

}  // namespace lastflat
