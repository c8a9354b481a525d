// The shortest path itself, from its distances.
#pragma once

#include "core/geodesic/exact_geodesics.h"

namespace lastflat {

/// A point of a path: on the edge from vertex a to vertex b, at this share of the way. At a vertex
/// a and b are the same.
struct PathPoint {
    Index a, b;
    double share;
};

/// The shortest path from the source to a vertex: its points on edges and at vertices, in order.
struct GeodesicPath {
    std::vector<PathPoint> points;
};

/// Unfolds the triangles backwards from the vertex along the straight line on which its shortest
/// path arrived; again from each vertex where that path bends.
///
/// In:     distances on the same unfolding; a vertex.
/// Out:    a path as long as the vertex's distance.
/// Throws: Error{solver_failed} if the line loses its way among degenerate triangles.
[[nodiscard]] GeodesicPath trace_path(const Unfolding& unfolding,
                                      const GeodesicDistances& distances, Index vertex);

/// The point of a path in space or in the plane, given the positions of the vertices.
template <class Points>
[[nodiscard]] auto position_of(const PathPoint& point, const Points& positions) ->
    typename Points::value_type {
    return (1.0 - point.share) * positions[static_cast<std::size_t>(point.a)] +
           point.share * positions[static_cast<std::size_t>(point.b)];
}

}  // namespace lastflat
