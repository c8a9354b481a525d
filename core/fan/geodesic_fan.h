// The geodesic fan of a region: its centre, and the border in polar coordinates around it.
#pragma once

#include "core/cut/region.h"
#include "core/geodesic/trace_path.h"

namespace lastflat {

struct FanSpoke {
    double angle;       ///< radians, counter-clockwise seen from outside
    double distance;    ///< mm
    GeodesicPath path;  ///< empty unless asked for
};

/// One spoke for each border vertex, in the order of the border. Angles are those of the conformal
/// plane at the centre: the surface's, scaled so that they go round once. They count from the
/// centre's first half-edge, until `on_base_line` turns them to the pattern's base line.
struct GeodesicFan {
    Index centre;
    double mean_distance;      ///< A_1 of the centre, mm
    double greatest_distance;  ///< A_inf of the centre, mm
    double radius;             ///< to the furthest border vertex, mm
    std::vector<FanSpoke> spokes;
    int runs;
};

/// Paper:  [kim-kim], sections 3.1 and 3.4; A_n: [hilaga-2001], integrated over the triangles with
///         the distance taken as linear on each.
/// In:     whether the spokes keep their paths, up to four million points in all.
/// Throws: Error{canceled}; Error{solver_failed} as its parts do.
[[nodiscard]] GeodesicFan geodesic_fan(const Region& region, bool keep_paths,
                                       const Progress& progress);

/// The triangles around a vertex in its conformal plane: angles scaled so that they go round once
/// (on the border: as they are).
class ConformalPlane {
public:
    struct Corner {
        Index to, apex;       ///< the triangle's other vertices, counter-clockwise
        double begin, scale;  ///< radians: where the side to `to` lies; plane over surface
    };
    ConformalPlane(const Region& region, Index vertex);

    /// Counter-clockwise, from the vertex's first half-edge.
    [[nodiscard]] const std::vector<Corner>& corners() const { return corners_; }
    /// The corner whose side runs to `to`, nullptr if there is none.
    [[nodiscard]] const Corner* side_to(Index to) const;

private:
    std::vector<Corner> corners_;
    std::vector<std::pair<Index, std::size_t>> by_side_;  ///< sorted
};

}  // namespace lastflat
