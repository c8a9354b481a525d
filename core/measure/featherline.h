// The zones of a featherline, and the points at which they end.
#pragma once

#include <array>
#include <optional>

#include "core/cut/region.h"
#include "core/request.h"
#include "core/weld/surface_mesh.h"

namespace lastflat {

/// From the toe point to the seat point.
enum class LastZone { toe, joint, waist, seat };

/// Where a zone ends, towards the seat.
struct ZoneEnd {
    std::string name;  ///< `toe_end_lateral`, `joint_end_medial`, ...
    Vec3 position;     ///< on the featherline
    double share;      ///< of the way from the seat point (0) to the toe point (1), along the axis
    bool given;        ///< by the request, not found
};

/// The featherline of one side of a last. Planes across the axis, from the seat point to the toe
/// point, part its zones.
struct FeatherlineSide {
    std::size_t region;
    Vec3 seat, toe;
    std::array<ZoneEnd, 3> ends;  ///< of toe, joint and waist
};

/// What one run of a featherline has in one zone.
struct ZoneReport {
    LastZone zone;
    double length_3d_mm, length_2d_mm;
};

/// The sides whose seat and toe are known: regions `lateral` and `medial` that have the curves
/// `featherline`, `heel` and `centre_front` (or `toe` and `instep`), which end on it. Shares count
/// from the length between seat point and toe point. The joint point is where the featherline is
/// widest, between 0.5 and 0.85 of it; the toe ends 0.1 before the joint point, the joint 0.1
/// behind it, the waist at 0.25. A point of the request, by one of these names, takes the place of
/// that which would be found.
///
/// Throws: Error{curve_invalid} at a point of the request that is not on the featherline of its
///         side, or lies on the wrong side of another.
[[nodiscard]] std::vector<FeatherlineSide> divide_featherlines(
    const SurfaceMesh& surface, const std::vector<Region>& regions,
    const std::vector<PointSource>& points);

/// One entry for each zone that the run has a part of, from the toe on.
[[nodiscard]] std::vector<ZoneReport> measure_zones(const FeatherlineSide& side,
                                                    const Region& region, const Points2& uv,
                                                    const CurveRun& run);

}  // namespace lastflat
