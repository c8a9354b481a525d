// The ends of a closed line, such as heel and toe of a featherline.
#pragma once

#include <utility>

#include "core/numerics/types.h"

namespace lastflat {

/// The two points of a closed line that are furthest apart, the one that lies further along
/// `forward` second. A round end has no corner to hold on to: there the distance from the other
/// end is fitted by a parabola, over a wider stretch at the first point (a heel) than at the second
/// (a toe), so that neither noise nor the spacing of the vertices moves the point along the line.
[[nodiscard]] std::pair<Vec3, Vec3> furthest_pair(const Points3& line, const Vec3& forward);

}  // namespace lastflat
