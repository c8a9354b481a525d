// Named curves on the surface.
#pragma once

#include <string>
#include <vector>

#include "core/locate/surface_search.h"
#include "core/request.h"

namespace lastflat {

/// A line on the surface: one triangle holds each two consecutive points. Closed if the first point
/// is also the last.
struct SurfaceLine {
    std::string name;
    std::vector<SurfacePoint> points;
    double snap = 0.0;  ///< how near to vertices and edges it may be put on them (tolerances.h)
    /// Its first and last point were put on another line or the border.
    bool starts_on_line = false, ends_on_line = false;
};

/// Which forms are located before which, the smallest first: what ends on others comes after them.
/// Vertex paths, groups' lines, border loops and closed drawn lines, then shortest paths, then open
/// drawn lines.
[[nodiscard]] int turn(const CurveForm& form);

/// Finds every curve on the surface, one after the other. Shortest paths are exact. The ends of
/// shortest paths and polylines that were given in space are put on the border or an earlier curve
/// within `tolerance::drawn_end_reach`.
///
/// In:     sources in the order of their turns.
/// Throws: Error{curve_invalid} naming the curve, the item and the position, if an id does not
/// exist
///         or is not on the selected faces, if two consecutive vertices share no edge, if a path
///         meets itself other than by closing, if a point is too far from the surface or names
///         nothing, or if groups do not meet along one line; Error{group_not_found}.
[[nodiscard]] std::vector<SurfaceLine> locate_curves(const SurfaceMesh& surface,
                                                     const std::vector<CurveSource>& sources,
                                                     const std::vector<PointSource>& points = {});

/// The same beside lines that were located before, on which the new ones may end; only those are
/// returned. `search`: of this surface.
[[nodiscard]] std::vector<SurfaceLine> locate_more_curves(const SurfaceSearch& search,
                                                          const SurfaceMesh& surface,
                                                          const std::vector<SurfaceLine>& before,
                                                          const std::vector<CurveSource>& sources,
                                                          const std::vector<PointSource>& points);

}  // namespace lastflat
