#include "core/fan/geodesic_centre.h"

#include <algorithm>
#include <limits>

#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

std::vector<Index> candidates(const Region& region) {
    std::vector<Index> inner, all;
    for (Index v = 0; v < region.half_edges.vertex_count(); ++v) {
        all.push_back(v);
        if (!region.half_edges.on_border(v)) inner.push_back(v);
    }
    return inner.empty() ? all : inner;
}

Index furthest_on_border(const Region& region, const GeodesicDistances& from) {
    return *std::max_element(region.border.begin(), region.border.end(), [&](Index a, Index b) {
        return from.distance[static_cast<std::size_t>(a)] <
               from.distance[static_cast<std::size_t>(b)];
    });
}

/// Furthest from the mean of the border: a good first bound.
Index outermost_on_border(const Region& region) {
    Vec3 mean = Vec3::Zero();
    for (const Index v : region.border) mean += region.position(v);
    mean /= static_cast<double>(region.border.size());
    return *std::max_element(region.border.begin(), region.border.end(), [&](Index a, Index b) {
        return (region.position(a) - mean).norm() < (region.position(b) - mean).norm();
    });
}

}  // namespace

GeodesicCentre geodesic_centre(const Region& region, const ExactGeodesics& geodesics,
                               const Progress& progress) {
    const auto vertices = candidates(region);
    std::vector<double> bound(region.positions.size(), 0.0);
    GeodesicCentre best;
    best.radius = std::numeric_limits<double>::infinity();
    for (Index border = outermost_on_border(region);;) {
        constexpr int most_runs = 64;  // tubes that are round all about have no other centre
        if (best.runs >= most_runs) {
            throw Error(ErrorCode::solver_failed, "too many vertices are equally central");
        }
        const GeodesicDistances inward = geodesics.from_vertex(border, progress);
        ++best.runs;
        for (std::size_t v = 0; v < bound.size(); ++v) {
            bound[v] = std::max(bound[v], inward.distance[v]);
        }
        const Index tried =
            *std::min_element(vertices.begin(), vertices.end(), [&](Index a, Index b) {
                return bound[static_cast<std::size_t>(a)] < bound[static_cast<std::size_t>(b)];
            });
        const double least = bound[static_cast<std::size_t>(tried)];
        if (least >= best.radius * (1.0 - tolerance::geodesic_round_off)) return best;
        GeodesicDistances outward = geodesics.from_vertex(tried, progress);
        ++best.runs;
        border = furthest_on_border(region, outward);
        const double radius = outward.distance[static_cast<std::size_t>(border)];
        bound[static_cast<std::size_t>(tried)] = radius;  // what it is now known to be
        if (radius < best.radius) {
            best.vertex = tried;
            best.radius = radius;
            best.distances = std::move(outward);
        }
        if (least >= best.radius * (1.0 - tolerance::geodesic_round_off)) return best;
    }
}

}  // namespace lastflat
