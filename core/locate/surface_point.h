// A point on the surface, in terms of the vertices it had before any curve was put in.
#pragma once

#include <algorithm>

#include "core/weld/surface_mesh.h"

namespace lastflat {

/// The weighted mean of a triangle's corners. A weight of exactly 0: the point is on the opposite
/// edge; two of them: at a vertex. A vertex of the surface has itself in all three corners.
struct SurfacePoint {
    Triangle corners{-1, -1, -1};
    Vec3 weights = Vec3::Zero();

    [[nodiscard]] static SurfacePoint at_vertex(Index vertex) {
        return {{vertex, vertex, vertex}, {1.0, 0.0, 0.0}};
    }
    /// On the edge from a to b, at this share of the way.
    [[nodiscard]] static SurfacePoint on_edge(Index a, Index b, double share) {
        return {{a, b, a}, {1.0 - share, share, 0.0}};
    }
    /// How much of the point a vertex is.
    [[nodiscard]] double weight_of(Index vertex) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < 3; ++i) {
            if (corners[i] == vertex) sum += weights[static_cast<Eigen::Index>(i)];
        }
        return sum;
    }
    /// The vertex, if the point is at one; else -1.
    [[nodiscard]] Index vertex() const {
        for (std::size_t i = 0; i < 3; ++i) {
            if (weight_of(corners[i]) == 1.0) return corners[i];
        }
        return -1;
    }
    /// The vertices that have a weight: one, two or three.
    [[nodiscard]] std::vector<Index> support() const {
        std::vector<Index> vertices;
        for (std::size_t i = 0; i < 3; ++i) {
            const Index v = corners[i];
            const bool known = contains(vertices, v);
            if (!known && weight_of(v) != 0.0) vertices.push_back(v);
        }
        return vertices;
    }
};

/// The point between two of which one triangle holds both.
[[nodiscard]] SurfacePoint between(const SurfacePoint& a, const SurfacePoint& b, double share);

[[nodiscard]] Vec3 position_of(const SurfaceMesh& surface, const SurfacePoint& point);

/// The faces that hold the point: one inside a face, two on an edge, all around a vertex.
[[nodiscard]] std::vector<Index> faces_at(const SurfaceMesh& surface, const SurfacePoint& point);

/// Whether one face holds both.
[[nodiscard]] bool share_a_face(const SurfaceMesh& surface, const SurfacePoint& a,
                                const SurfacePoint& b);

[[nodiscard]] Triangle corners_of(const SurfaceMesh& surface, Index face);

}  // namespace lastflat
