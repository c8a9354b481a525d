// Based on: Kim, Kim, "Geodesic-Fan Based Mesh Parameterization in Shoe CAD System"; Hilaga,
// Shinagawa, Kohmura, Kunii, "Topology Matching", SIGGRAPH 2001.
#include "core/fan/geodesic_fan.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/fan/geodesic_centre.h"
#include "core/numerics/geometry.h"

namespace lastflat {
namespace {

using std::numbers::pi;

/// The direction in which a path leaves its source vertex, in the vertex's conformal plane.
double angle_of_departure(const Region& region, const ConformalPlane& plane, Index vertex,
                          const GeodesicPath& path) {
    const PathPoint& second = path.points[1];
    const auto angle_in = [&](const ConformalPlane::Corner& corner) {
        return corner.begin + corner.scale * angle_at(region.position(vertex),
                                                      region.position(corner.to),
                                                      position_of(second, region.positions));
    };
    const auto* from_a = plane.side_to(second.a);
    if (second.a == second.b) {
        if (from_a != nullptr) return from_a->begin;
        const auto& last = plane.corners().back();  // the border's second edge begins no triangle
        if (last.apex == second.a) return angle_in(last);
    } else {
        if (from_a != nullptr && from_a->apex == second.b) return angle_in(*from_a);
        const auto* from_b = plane.side_to(second.b);
        if (from_b != nullptr && from_b->apex == second.a) return angle_in(*from_b);
    }
    throw Error(ErrorCode::solver_failed, "a spoke of the geodesic fan has no direction");
}

double mean_over_surface(const Region& region, const std::vector<double>& values) {
    double sum = 0.0, area = 0.0;
    for (const Triangle& t : region.triangles) {
        const double doubled = doubled_area_vector(region, t).norm();
        area += doubled;
        for (const Index v : t) sum += doubled * values[static_cast<std::size_t>(v)] / 3.0;
    }
    return sum / area;
}

}  // namespace

ConformalPlane::ConformalPlane(const Region& region, Index vertex) {
    const HalfEdges& half_edges = region.half_edges;
    double total = 0.0;
    for (const Index h : half_edges.around(vertex)) total += frame_of(region, h).angle();
    const double scale = half_edges.on_border(vertex) ? 1.0 : 2.0 * pi / total;
    double begin = 0.0;
    for (const Index h : half_edges.around(vertex)) {
        by_side_.emplace_back(half_edges.to(h), corners_.size());
        corners_.push_back({half_edges.to(h), half_edges.apex(h), begin, scale});
        begin += scale * frame_of(region, h).angle();
    }
    std::sort(by_side_.begin(), by_side_.end());
}

const ConformalPlane::Corner* ConformalPlane::side_to(Index to) const {
    const auto found =
        std::lower_bound(by_side_.begin(), by_side_.end(), std::pair(to, std::size_t{0}));
    return found != by_side_.end() && found->first == to ? &corners_[found->second] : nullptr;
}

GeodesicFan geodesic_fan(const Region& region, bool keep_paths, const Progress& progress) {
    const ExactGeodesics geodesics(Unfolding(region, region.half_edges));
    const GeodesicCentre centre = geodesic_centre(region, geodesics, progress);
    const auto& distance = centre.distances.distance;
    GeodesicFan fan{centre.vertex,
                    mean_over_surface(region, distance),
                    *std::max_element(distance.begin(), distance.end()),
                    centre.radius,
                    {},
                    centre.runs};
    const ConformalPlane plane(region, centre.vertex);
    constexpr std::size_t most_points = 4'000'000;
    std::size_t points = 0;
    for (const Index v : region.border) {
        progress.check();
        GeodesicPath path = trace_path(geodesics.unfolding(), centre.distances, v);
        // Only where no vertex is inner is the centre itself on the border.
        const double angle =
            v == centre.vertex ? 0.0 : angle_of_departure(region, plane, centre.vertex, path);
        points += keep_paths ? path.points.size() : 0;
        if (points > most_points) {
            throw Error(ErrorCode::solver_failed, "its paths have too many points to be drawn");
        }
        fan.spokes.push_back({angle, distance[static_cast<std::size_t>(v)],
                              keep_paths ? std::move(path) : GeodesicPath{}});
    }
    return fan;
}

}  // namespace lastflat
