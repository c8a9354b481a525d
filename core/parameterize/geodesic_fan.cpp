// Based on: Kim, Kim, "Geodesic-Fan Based Mesh Parameterization in Shoe CAD System".
#include "core/parameterize/geodesic_fan.h"

#include <algorithm>
#include <numeric>

#include "core/border/convex_border.h"
#include "core/border/tweak_edges.h"
#include "core/error.h"
#include "core/numerics/polygon.h"
#include "core/parameterize/convex_combination.h"

namespace lastflat {
namespace {

/// "curve 'heel', at 1.0 2.0 3.0": the first named curve along border edge i, and its place.
std::string border_edge_name(const Region& region, std::size_t i) {
    const Index a = region.border[i], b = region.border[(i + 1) % region.border.size()];
    const std::string where = "at " + place(region.position(a));
    for (const CurveRun& run : region.runs) {
        for (std::size_t k = 1; k < run.vertices.size(); ++k) {
            const Index p = run.vertices[k - 1], q = run.vertices[k];
            if ((p == a && q == b) || (p == b && q == a))
                return "curve '" + run.curve + "', " + where;
        }
    }
    return "the border " + where;
}

/// The star of border vertex i: inside as flattened, outside as the layer lies in the plane.
/// Vertices count from 0, their virtual partners follow in border order.
Star floating_star(const Region& region, const OneRings& rings, std::size_t i,
                   const std::vector<double>& corners, const Points2& polygon,
                   const Points2& partners) {
    const std::size_t n = region.border.size(), before = (i + n - 1) % n, after = (i + 1) % n;
    const Index vertex = region.border[i];
    const auto first_partner = static_cast<Index>(region.positions.size());
    Star star;
    const auto ring = rings.of(vertex);
    star.neighbours.assign(ring.begin(), ring.end());
    star.angles = corners;
    for (const Index neighbour : ring) star.distances.push_back(region.distance(vertex, neighbour));

    const Vec2& here = polygon[i];
    star.angles.push_back(angle_at(here, polygon[before], partners[before]));
    star.neighbours.push_back(first_partner + static_cast<Index>(before));
    star.distances.push_back((partners[before] - here).norm());
    star.angles.push_back(angle_at(here, partners[before], partners[i]));
    star.neighbours.push_back(first_partner + static_cast<Index>(i));
    star.distances.push_back((partners[i] - here).norm());
    star.angles.push_back(angle_at(here, partners[i], polygon[after]));
    return star;
}

}  // namespace

Chart flatten_geodesic_fan(const Region& region, const std::vector<bool>& locked, AngleRule rule) {
    const OneRings rings(region);
    const BorderAngles angles = border_angles(region, rings, rule);
    const auto lengths = border_lengths(region);
    const Points2 polygon = tweak_edges(lengths, angles.turning, locked, [&](std::size_t edge) {
        return border_edge_name(region, edge);
    });
    const double mean_edge =
        std::accumulate(lengths.begin(), lengths.end(), 0.0) / static_cast<double>(lengths.size());
    const Points2 partners = virtual_layer(hull_border(polygon), mean_edge);

    WeightRows rows(region.positions.size() + partners.size());
    for (std::size_t v = 0; v < region.positions.size(); ++v) {
        const auto vertex = static_cast<Index>(v);
        if (!rings.on_border(vertex)) {
            rows[v] = mean_value_weights(surface_star(region, rings, vertex));
        }
    }
    for (std::size_t i = 0; i < region.border.size(); ++i) {
        rows[static_cast<std::size_t>(region.border[i])] = mean_value_weights(
            floating_star(region, rings, i, angles.corners[i], polygon, partners));
    }
    Points2 fixed(region.positions.size(), Vec2::Zero());
    fixed.insert(fixed.end(), partners.begin(), partners.end());
    Points2 points = solve_convex_combinations(rows, fixed);
    points.resize(region.positions.size());
    return {std::move(points)};
}

}  // namespace lastflat
