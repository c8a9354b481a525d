// Convex positions for the border, and the virtual layer around it.
#pragma once

#include "core/cut/region.h"

namespace lastflat {

/// On a circle as long as the border, by chord length. Counter-clockwise, centre at the origin.
[[nodiscard]] Points2 circle_border(const Region& region);

/// On a square as long as the border, by chord length, corners at border vertices: of all starts,
/// the one whose four vertices nearest to the quarter points are sharpest on the surface.
[[nodiscard]] Points2 square_border(const Region& region);

/// Each vertex on the convex hull of the polygon: corners of the hull stay, the others go on the
/// hull edge over them at their share of the arc length between its ends.
/// Throws: Error{method_failed} if the polygon winds so that its hull has another order.
[[nodiscard]] Points2 hull_border(const Points2& polygon);

/// A convex border whose sides bulge by at most 1 % of their length where an edge inside the region
/// joins two vertices of one side: straight, they would leave no room for what the edge cuts off.
[[nodiscard]] Points2 bulged_under_chords(const Region& region, Points2 convex);

/// One virtual partner for each vertex of a convex polygon, moved outward by `distance`: collinear
/// vertices stay collinear, so the layer is convex as well.
///
/// Paper: [lee-2002], one layer.
[[nodiscard]] Points2 virtual_layer(const Points2& convex, double distance);

}  // namespace lastflat
