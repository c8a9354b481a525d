// Named curves on the surface.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/locate/surface_place.h"

namespace lastflat {

/// A named place: a vertex of the file, or a point near the surface.
struct PointSource {
    std::string name;
    std::optional<Index> vertex;
    std::optional<Vec3> position;  ///< mm
};

/// What the request says of a curve: one of the six.
struct CurveSource {
    std::string name;
    std::vector<Index> vertices{};           ///< ids of the file; consecutive ones share an edge
    Points3 polyline{};                      ///< in space near the surface, mm
    std::vector<std::string> through{};      ///< named points, joined by shortest paths
    std::vector<std::string> border_of{};    ///< one group: its border; two: where they meet
    std::string line{};                      ///< a line of the model, by name
    std::optional<PointSource> border_at{};  ///< the border loop at this place
};

/// A line on the surface: one triangle holds each two consecutive places. Closed if the first place
/// is also the last.
struct SurfaceLine {
    std::string name;
    std::vector<SurfacePlace> places;
    double snap = 0.0;  ///< how near to vertices and edges it may be put on them (tolerances.h)
};

/// How far a drawn point may be from the surface, and how near to another curve or to the border
/// the end of a drawn curve must be to be put on it, as shares of the surface's size: about 6 mm
/// and 1.2 mm on a last.
inline constexpr double drawn_reach = 0.02, drawn_end_reach = 0.004;

/// Finds every curve on the surface, in the order of the sources. Shortest paths are exact. The
/// ends of shortest paths and polylines that were given in space are put on the border or another
/// curve within `drawn_end_reach`: vertex paths and groups' lines count first, then shortest paths,
/// then what is drawn, each in its order.
///
/// Throws: Error{curve_invalid} naming the curve, the item and the place, if an id does not exist
///         or is not on the selected faces, if two consecutive vertices share no edge, if a path
///         meets itself other than by closing, if a point is too far from the surface or names
///         nothing, or if groups do not meet along one line; Error{group_not_found}.
[[nodiscard]] std::vector<SurfaceLine> locate_curves(const SurfaceMesh& surface,
                                                     const std::vector<CurveSource>& sources,
                                                     const std::vector<PointSource>& points = {});

}  // namespace lastflat
