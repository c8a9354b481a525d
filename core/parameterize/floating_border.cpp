// Based on: Kim, Kim, "Geodesic-Fan Based Mesh Parameterization in Shoe CAD System".
#include "core/parameterize/floating_border.h"

#include <algorithm>
#include <numeric>

#include "core/border/convex_border.h"
#include "core/numerics/geometry.h"
#include "core/parameterize/convex_combination.h"

namespace lastflat {
namespace {

/// The star of border vertex i: inside as flattened, outside as the layer lies in the plane.
/// Vertices count from 0, their virtual partners follow in border order.
Star floating_star(const Region& region, std::size_t i, const BorderPolygon& polygon,
                   const Points2& partners) {
    const std::size_t n = region.border.size(), before = (i + n - 1) % n, after = (i + 1) % n;
    const Index vertex = region.border[i];
    const auto first_partner = static_cast<Index>(region.positions.size());
    Star star;
    star.neighbours = region.half_edges.ring(vertex);
    star.angles = polygon.angles.corners[i];
    for (const Index neighbour : star.neighbours)
        star.distances.push_back(region.distance(vertex, neighbour));

    const Vec2& here = polygon.points[i];
    star.angles.push_back(angle_at(here, polygon.points[before], partners[before]));
    star.neighbours.push_back(first_partner + static_cast<Index>(before));
    star.distances.push_back((partners[before] - here).norm());
    star.angles.push_back(angle_at(here, partners[before], partners[i]));
    star.neighbours.push_back(first_partner + static_cast<Index>(i));
    star.distances.push_back((partners[i] - here).norm());
    star.angles.push_back(angle_at(here, partners[i], polygon.points[after]));
    return star;
}

}  // namespace

Chart flatten_floating_border(const Region& region, const Dissection& dissection,
                              WeightRule weights, const BorderPolygon& polygon) {
    const auto lengths = border_lengths(region);
    const double mean_edge =
        std::accumulate(lengths.begin(), lengths.end(), 0.0) / static_cast<double>(lengths.size());
    const Points2 partners = virtual_layer(hull_border(polygon.points), mean_edge);

    WeightRows rows(region.positions.size() + partners.size());
    for (std::size_t v = 0; v < region.positions.size(); ++v) {
        const auto vertex = static_cast<Index>(v);
        if (!region.half_edges.on_border(vertex)) {
            rows[v] = weighted_neighbours(surface_star(region, vertex), weights);
        }
    }
    for (std::size_t i = 0; i < region.border.size(); ++i) {
        rows[static_cast<std::size_t>(region.border[i])] =
            weighted_neighbours(floating_star(region, i, polygon, partners), weights);
    }
    Points2 fixed(region.positions.size(), Vec2::Zero());
    fixed.insert(fixed.end(), partners.begin(), partners.end());
    Points2 points = solve_convex_combinations(rows, fixed, dissection);
    points.resize(region.positions.size());
    return {std::move(points)};
}

}  // namespace lastflat
