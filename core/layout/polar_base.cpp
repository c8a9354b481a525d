#include <cmath>
#include <numbers>

#include "core/layout/sheet.h"
#include "core/numerics/geometry.h"

namespace lastflat {
namespace {

/// Where +x leaves the centre: the surface direction that the chart maps on it, in the conformal
/// plane of the centre. From a centre on the border +x may leave the region: then it is counted
/// from the side nearest to it.
double polar_base(const Region& region, const Points2& uv, Index centre) {
    const ConformalPlane plane(region, centre);
    const auto at = [&](Index v) -> const Vec2& { return uv[static_cast<std::size_t>(v)]; };
    const Vec3& origin = region.position(centre);
    double nearest = HUGE_VAL, base = 0.0;
    const auto take_nearest = [&](const Vec2& side, double angle) {
        const double off = std::atan2(side.y(), side.x());  // in the chart, from +x
        if (std::abs(off) >= nearest) return;
        nearest = std::abs(off);
        base = angle - off;
    };
    for (const ConformalPlane::Corner& corner : plane.corners()) {
        const Vec2 to_a = at(corner.to) - at(centre), to_b = at(corner.apex) - at(centre);
        const double area = cross(to_a, to_b);
        const double of_a = cross(Vec2::UnitX(), to_b) / area;
        const double of_b = cross(to_a, Vec2::UnitX()) / area;
        const double angle = corner.scale * angle_at(origin, region.position(corner.to),
                                                     region.position(corner.apex));
        if (of_a >= 0.0 && of_b >= 0.0) {
            const Vec3 direction = of_a * (region.position(corner.to) - origin) +
                                   of_b * (region.position(corner.apex) - origin);
            return corner.begin + corner.scale * angle_at<Vec3>(origin, region.position(corner.to),
                                                                origin + direction);
        }
        take_nearest(to_a, corner.begin);
        take_nearest(to_b, corner.begin + angle);
    }
    return base;
}

}  // namespace

GeodesicFan on_base_line(const Region& region, const Chart& chart, GeodesicFan fan) {
    const double base = polar_base(region, chart.uv, fan.centre);
    for (FanSpoke& spoke : fan.spokes) {
        spoke.angle = std::remainder(spoke.angle - base, 2.0 * std::numbers::pi);
    }
    return fan;
}

}  // namespace lastflat
