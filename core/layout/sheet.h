// Where the flat pieces lie on the sheet.
#pragma once

#include "core/constrain/pins.h"
#include "core/fan/geodesic_fan.h"
#include "core/parameterize/chart.h"

namespace lastflat {

/// A piece's points go to the sheet by: mirror (y -> -y) if mirrored, then turn, then move.
struct Placement {
    bool mirrored = false;
    double rotation = 0.0;            ///< radians, counter-clockwise
    Vec2 translation = Vec2::Zero();  ///< mm

    [[nodiscard]] Vec2 apply(const Vec2& point) const;
};

/// Lower left corner at the origin, y up, mm. One placement per region, in their order.
struct Sheet {
    double width = 0.0, height = 0.0;
    std::vector<Placement> placements;
};

/// Turns every chart so that it lies as a pattern is read: base line (from the seat to the toe
/// point) along +x, the seat at the origin. Seat and toe point are the ends of the curves `heel`
/// and `centre_front` (or its parts `toe` and `instep`) towards the longer stretch of border
/// between them. Where a region lacks them, the long axis of all regions in space takes the base
/// line's place, and the chart's centroid is the origin.
///
/// A chart with one pinned vertex is turned and then has it in its position; one with
/// more is moved to them.
///
/// Out: charts that do not depend on how the last lay in space.
void orient_charts(const std::vector<Region>& regions, const std::vector<Constraint>& constraints,
                   std::vector<Chart>& charts);

/// The fan with its angles counted from the direction in which the oriented chart's +x leaves the
/// centre on the surface, in [-pi, pi]: of an isometry, the chart's own polar coordinates.
///
/// Paper: [kim-kim], section 3.1 (the polar base).
[[nodiscard]] GeodesicFan on_base_line(const Region& region, const Chart& chart, GeodesicFan fan);

/// The pieces one above the other, same way up, toe to the right, at least `gap` mm apart measured
/// upward, as close as their outlines allow; a piece whose other side faces the viewer is mirrored.
///
/// Paper: [kim-kim], Fig. 1.
/// In:    charts as `orient_charts` leaves them.
[[nodiscard]] Sheet arrange_pair(const std::vector<Region>& regions,
                                 const std::vector<Chart>& charts, double gap);

}  // namespace lastflat
