// Based on: Kim, Kim, "Geodesic-Fan Based Mesh Parameterization in Shoe CAD System"; Hilaga,
// Shinagawa, Kohmura, Kunii, "Topology Matching", SIGGRAPH 2001.
#include "core/geodesic/geodesic_fan.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geodesic/geodesic_centre.h"
#include "core/numerics/polygon.h"

namespace lastflat {
namespace {

using std::numbers::pi;

/// The direction in which a path leaves its source vertex, in the vertex's conformal plane.
double angle_of_departure(const Region& region, const HalfEdges& half_edges, Index vertex,
                          const GeodesicPath& path) {
    const PathPoint& second = path.points[1];
    const Vec3 place = place_of(second, region.positions);
    const Index first = half_edges.outgoing(vertex);
    for (Index h = first; h >= 0;) {
        const Index a = half_edges.to(h), b = half_edges.apex(h);
        const bool along_edge = second.a == second.b && (second.a == a || second.a == b);
        const bool through =
            second.a != second.b && std::minmax(second.a, second.b) == std::minmax(a, b);
        if (along_edge || through) {
            return conformal_angle(half_edges, h,
                                   angle_at(region.position(vertex), region.position(a), place));
        }
        h = half_edges.rotated(h);
        if (h == first) break;
    }
    throw Error(ErrorCode::solver_failed, "a spoke of the geodesic fan has no direction");
}

double mean_over_surface(const Region& region, const std::vector<double>& values) {
    double sum = 0.0, area = 0.0;
    for (const Triangle& t : region.triangles) {
        const double doubled = (region.position(t[1]) - region.position(t[0]))
                                   .cross(region.position(t[2]) - region.position(t[0]))
                                   .norm();
        area += doubled;
        for (const Index v : t) sum += doubled * values[static_cast<std::size_t>(v)] / 3.0;
    }
    return sum / area;
}

}  // namespace

double conformal_angle(const HalfEdges& half_edges, Index half_edge, double beyond) {
    const Index vertex = half_edges.from(half_edge);
    double before = 0.0;
    for (Index h = half_edges.outgoing(vertex); h != half_edge; h = half_edges.rotated(h)) {
        before += half_edges.angle(h);
    }
    const double scale =
        half_edges.on_border(vertex) ? 1.0 : 2.0 * pi / half_edges.total_angle(vertex);
    return scale * (before + beyond);
}

GeodesicFan geodesic_fan(const Region& region, const Progress& progress) {
    const ExactGeodesics geodesics(region);
    const GeodesicCentre centre = geodesic_centre(region, geodesics, progress);
    const auto& distance = centre.distances.distance;
    GeodesicFan fan{centre.vertex,
                    mean_over_surface(region, distance),
                    *std::max_element(distance.begin(), distance.end()),
                    centre.radius,
                    {},
                    centre.runs};
    for (const Index v : region.border) {
        fan.spokes.push_back({0.0, distance[static_cast<std::size_t>(v)],
                              trace_path(geodesics.half_edges(), centre.distances, v)});
        if (v == centre.vertex) continue;  // only where no vertex is inner
        fan.spokes.back().angle = angle_of_departure(region, geodesics.half_edges(), centre.vertex,
                                                     fan.spokes.back().path);
    }
    return fan;
}

}  // namespace lastflat
