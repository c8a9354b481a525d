#include "core/locate/shortest_paths.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/geodesic/trace_path.h"
#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

/// The surface with the given points as vertices.
class WithPoints {
public:
    explicit WithPoints(const SurfaceMesh& surface) : surface_(surface) {
        ids_.assign(surface.mesh.n_vertices(), -1);
        for (const auto face : surface.mesh.faces()) {
            Triangle triangle{};
            const Triangle corners = corners_of(surface, face.idx());
            for (std::size_t i = 0; i < 3; ++i) {
                Index& id = ids_[static_cast<std::size_t>(corners[i])];
                if (id < 0) id = add(SurfacePoint::at_vertex(corners[i]));
                triangle[i] = id;
            }
            mesh_.triangles.push_back(triangle);
        }
    }

    Index vertex_at(const SurfacePoint& point) {
        if (const Index v = point.vertex(); v >= 0) return ids_[static_cast<std::size_t>(v)];
        const auto same = std::find_if(points_.begin(), points_.end(), [&](const SurfacePoint& p) {
            return p.corners == point.corners && p.weights == point.weights;
        });
        if (same != points_.end()) return static_cast<Index>(same - points_.begin());
        const Index vertex = add(point);
        // The triangles whose border or inside the point is on: one, or two at an edge.
        for (std::size_t t = mesh_.triangles.size(); t-- > 0;) split(t, vertex, point);
        return vertex;
    }

    [[nodiscard]] const Triangulation& mesh() const { return mesh_; }
    [[nodiscard]] SurfacePoint surface_point(const PathPoint& point) const {
        const auto& a = points_[static_cast<std::size_t>(point.a)];
        return point.a == point.b
                   ? a
                   : between(a, points_[static_cast<std::size_t>(point.b)], point.share);
    }

private:
    Index add(const SurfacePoint& point) {
        points_.push_back(point);
        mesh_.positions.push_back(position_of(surface_, point));
        return static_cast<Index>(points_.size()) - 1;
    }

    /// How much of a corner's triangle lies between the point and the opposite side; the three
    /// shares are weights in the triangle.
    [[nodiscard]] Vec3 shares(const Triangle& t, const SurfacePoint& point) const {
        Eigen::Matrix3d corners;
        Vec3 target;
        const std::vector<Index> rows = rows_of(t, point);
        if (rows.empty()) return Vec3::Constant(-1.0);
        for (Eigen::Index r = 0; r < 3; ++r) {
            const Index row = rows[static_cast<std::size_t>(r)];
            target[r] = point.weight_of(row);
            for (Eigen::Index c = 0; c < 3; ++c)
                corners(r, c) =
                    points_[static_cast<std::size_t>(t[static_cast<std::size_t>(c)])].weight_of(
                        row);
        }
        return corners.partialPivLu().solve(target);
    }
    /// The old face's corners, if the triangle is a part of one that holds the point.
    [[nodiscard]] std::vector<Index> rows_of(const Triangle& t, const SurfacePoint& point) const {
        std::vector<Index> rows;
        for (const Index v : t) {
            for (const Index row : points_[static_cast<std::size_t>(v)].support()) {
                if (!contains(rows, row)) rows.push_back(row);
            }
        }
        const auto support = point.support();
        const bool holds =
            rows.size() == 3 &&
            std::all_of(support.begin(), support.end(), [&](Index v) { return contains(rows, v); });
        return holds ? rows : std::vector<Index>{};
    }

    void split(std::size_t t, Index vertex, const SurfacePoint& point) {
        const Triangle whole = mesh_.triangles[t];
        const Vec3 share = shares(whole, point);
        if (share.minCoeff() < -tolerance::solved_weight) return;
        std::vector<Triangle> parts;
        for (std::size_t i = 0; i < 3; ++i) {
            if (share[static_cast<Eigen::Index>((i + 2) % 3)] <= tolerance::solved_weight) continue;
            parts.push_back({whole[i], whole[(i + 1) % 3], vertex});
        }
        mesh_.triangles[t] = parts.front();
        mesh_.triangles.insert(mesh_.triangles.end(), parts.begin() + 1, parts.end());
    }

    const SurfaceMesh& surface_;
    Triangulation mesh_;
    std::vector<Index> ids_;            ///< per vertex of the surface
    std::vector<SurfacePoint> points_;  ///< per vertex of the mesh
};

}  // namespace

std::vector<SurfacePoint> shortest_paths(const SurfaceMesh& surface,
                                         const std::vector<SurfacePoint>& through) {
    WithPoints with_points(surface);
    std::vector<Index> stops;
    stops.reserve(through.size());
    for (const SurfacePoint& point : through) stops.push_back(with_points.vertex_at(point));
    const ExactGeodesics geodesics(with_points.mesh());
    std::vector<SurfacePoint> line{through.front()};
    for (std::size_t i = 1; i < stops.size(); ++i) {
        const auto distances = geodesics.from_vertex(stops[i - 1], Progress());
        if (!std::isfinite(distances.distance[static_cast<std::size_t>(stops[i])])) {
            const Vec3 position = position_of(surface, through[i]);
            throw Error(ErrorCode::curve_invalid,
                        "no way leads over the surface to " + position_text(position))
                .at_position(position);
        }
        const GeodesicPath path = trace_path(geodesics.unfolding(), distances, stops[i]);
        for (std::size_t k = 1; k < path.points.size(); ++k)
            line.push_back(with_points.surface_point(path.points[k]));
    }
    return line;
}

}  // namespace lastflat
