#include "core/measure/featherline.h"

#include <algorithm>
#include <cmath>

#include "core/layout/base_line.h"
#include "core/numerics/geometry.h"
#include "core/numerics/tolerances.h"
#include "core/text.h"

namespace lastflat {
namespace {

/// Shares of the length from seat to toe.
constexpr double joint_from = 0.5, joint_to = 0.85, around_joint = 0.1, seat_end = 0.25;

constexpr std::array<const char*, 3> end_names{point_name::toe_end, point_name::joint_end,
                                               point_name::waist_end};

/// Where on the way from seat to toe.
double share_of(const FeatherlineSide& side, const Vec3& p) {
    const Vec3 axis = side.toe - side.seat;
    return axis.dot(p - side.seat) / axis.squaredNorm();
}

bool is_featherline(const CurveRun& run) {
    return run.curve == curve_name::featherline;
}

bool is_centre_line(const CurveRun& run) {
    return run.curve == curve_name::centre_front || run.curve == curve_name::toe ||
           run.curve == curve_name::instep || run.curve == curve_name::heel;
}

template <class Visit>
void for_featherline_edges(const Region& region, const Visit& visit) {
    for (const CurveRun& run : region.runs) {
        for (std::size_t i = 1; is_featherline(run) && i < run.vertices.size(); ++i)
            visit(region.position(run.vertices[i - 1]), region.position(run.vertices[i]));
    }
}

bool is_on_featherline(const Region& region, Index vertex) {
    return std::any_of(region.runs.begin(), region.runs.end(), [&](const CurveRun& run) {
        return is_featherline(run) && contains(run.vertices, vertex);
    });
}

/// Away from the upright plane through the axis: the curves of the centre line lie beside it.
std::optional<Vec3> outward(const FeatherlineSide& side, const Region& region) {
    Vec3 sum = Vec3::Zero();
    for (const CurveRun& run : region.runs) {
        for (std::size_t i = 0; is_centre_line(run) && i < run.vertices.size(); ++i)
            sum += region.position(run.vertices[i]) - side.seat;
    }
    const Vec3 normal = (side.toe - side.seat).cross(sum);
    if (normal.norm() == 0.0) return std::nullopt;
    return normal.normalized();
}

/// The share of the widest vertex.
std::optional<double> joint_share(const FeatherlineSide& side, const Region& region) {
    const auto normal = outward(side, region);
    if (!normal) return std::nullopt;
    std::optional<double> joint;
    double widest = 0.0;
    for_featherline_edges(region, [&](const Vec3& a, const Vec3& b) {
        for (const Vec3& p : {a, b}) {
            const double share = share_of(side, p);
            const double width = std::abs(normal->dot(p - side.seat));
            if (share < joint_from || share > joint_to || width <= widest) continue;
            widest = width;
            joint = share;
        }
    });
    return joint;
}

/// The first point of the featherline there.
std::optional<Vec3> position_at(const FeatherlineSide& side, const Region& region, double share) {
    std::optional<Vec3> found;
    for_featherline_edges(region, [&](const Vec3& a, const Vec3& b) {
        const double from = share_of(side, a), to = share_of(side, b);
        if (found || (from < share) == (to < share)) return;
        found = a + (share - from) / (to - from) * (b - a);
    });
    return found;
}

[[noreturn]] void fail_point(const PointSource& point, const std::string& what) {
    throw Error(ErrorCode::curve_invalid, "point '" + point.name + "' " + what)
        .at_option({"points", point.name});
}

Vec3 position_of(const SurfaceMesh& surface, const PointSource& point) {
    if (const auto* position = std::get_if<Vec3>(&point.location)) return *position;
    const Index vertex = std::get<Index>(point.location);
    if (!surface.is_on_surface(vertex))
        fail_point(point,
                   "is vertex " + std::to_string(vertex) + ", which is not on the selected faces");
    return surface.position(surface.welded_to[at(vertex)]);
}

ZoneEnd given_end(const FeatherlineSide& side, const Region& region, const SurfaceMesh& surface,
                  const PointSource& point) {
    const Vec3 place = position_of(surface, point);
    Vec3 nearest = place;
    double distance = HUGE_VAL;
    for_featherline_edges(region, [&](const Vec3& a, const Vec3& b) {
        const Vec3 p = a + nearest_share(a, b, place) * (b - a);
        if ((p - place).norm() >= distance) return;
        distance = (p - place).norm();
        nearest = p;
    });
    const double most = tolerance::drawn_reach * (side.toe - side.seat).norm();
    if (distance > most)
        fail_point(point, "is " + fixed_text(distance, 1) + " mm away from the featherline of '" +
                              region.name + "' (at most " + fixed_text(most, 1) + " mm)");
    return {point.name, nearest, share_of(side, nearest), true};
}

const PointSource* named(const std::vector<PointSource>& points, const std::string& name) {
    const auto point = std::find_if(points.begin(), points.end(),
                                    [&](const PointSource& p) { return p.name == name; });
    return point == points.end() ? nullptr : &*point;
}

void check_order(const FeatherlineSide& side, const std::vector<PointSource>& points) {
    for (std::size_t i = 1; i < side.ends.size(); ++i) {
        const ZoneEnd &before = side.ends[i - 1], &end = side.ends[i];
        if (end.share < before.share) continue;
        fail_point(*named(points, end.given ? end.name : before.name),
                   "is out of its order: from the toe come '" + before.name + "', then '" +
                       end.name + "'");
    }
}

std::optional<FeatherlineSide> divided(const SurfaceMesh& surface,
                                       const std::vector<Region>& regions, std::size_t r,
                                       const std::vector<PointSource>& points) {
    const Region& region = regions[r];
    if (region.name != region_name::lateral && region.name != region_name::medial)
        return std::nullopt;
    const auto base = named_base_line(region);
    if (!base || !is_on_featherline(region, base->seat) || !is_on_featherline(region, base->toe))
        return std::nullopt;
    FeatherlineSide side{r, region.position(base->seat), region.position(base->toe), {}};
    const auto joint = joint_share(side, region);
    if (!joint) return std::nullopt;
    const std::array shares{*joint + around_joint, *joint - around_joint, seat_end};
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const std::string name = std::string(end_names[i]) + "_" + region.name;
        if (const PointSource* point = named(points, name)) {
            side.ends[i] = given_end(side, region, surface, *point);
            continue;
        }
        const auto position = position_at(side, region, shares[i]);
        if (!position) return std::nullopt;
        side.ends[i] = {name, *position, shares[i], false};
    }
    check_order(side, points);
    return side;
}

}  // namespace

std::vector<FeatherlineSide> divide_featherlines(const SurfaceMesh& surface,
                                                 const std::vector<Region>& regions,
                                                 const std::vector<PointSource>& points) {
    std::vector<FeatherlineSide> sides;
    for (std::size_t r = 0; r < regions.size(); ++r) {
        if (auto side = divided(surface, regions, r, points)) sides.push_back(std::move(*side));
    }
    return sides;
}

std::vector<ZoneReport> measure_zones(const FeatherlineSide& side, const Region& region,
                                      const Points2& uv, const CurveRun& run) {
    std::array<ZoneReport, 4> zones{};
    for (std::size_t z = 0; z < zones.size(); ++z) zones[z].zone = static_cast<LastZone>(z);
    for (std::size_t i = 1; i < run.vertices.size(); ++i) {
        const Index a = run.vertices[i - 1], b = run.vertices[i];
        const double from = share_of(side, region.position(a));
        const double to = share_of(side, region.position(b));
        std::vector<double> cuts{0.0, 1.0};  // where the edge goes over into another zone
        for (const ZoneEnd& end : side.ends) {
            if ((from < end.share) != (to < end.share))
                cuts.push_back((end.share - from) / (to - from));
        }
        std::sort(cuts.begin(), cuts.end());
        for (std::size_t c = 1; c < cuts.size(); ++c) {
            const double middle = from + 0.5 * (cuts[c - 1] + cuts[c]) * (to - from);
            const auto zone = std::count_if(side.ends.begin(), side.ends.end(),
                                            [&](const ZoneEnd& e) { return middle < e.share; });
            ZoneReport& report = zones[static_cast<std::size_t>(zone)];
            report.length_3d_mm += (cuts[c] - cuts[c - 1]) * region.distance(a, b);
            report.length_2d_mm += (cuts[c] - cuts[c - 1]) * (uv[at(a)] - uv[at(b)]).norm();
        }
    }
    std::vector<ZoneReport> present;
    for (const ZoneReport& report : zones) {
        if (report.length_3d_mm > 0.0) present.push_back(report);
    }
    return present;
}

}  // namespace lastflat
