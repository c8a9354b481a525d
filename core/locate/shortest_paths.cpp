#include "core/locate/shortest_paths.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/geodesic/trace_path.h"
#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

/// The surface with the given places as vertices.
class WithPlaces {
public:
    explicit WithPlaces(const SurfaceMesh& surface) : surface_(surface) {
        ids_.assign(surface.mesh.n_vertices(), -1);
        for (const auto face : surface.mesh.faces()) {
            Triangle triangle{};
            const Triangle corners = corners_of(surface, face.idx());
            for (std::size_t i = 0; i < 3; ++i) {
                Index& id = ids_[static_cast<std::size_t>(corners[i])];
                if (id < 0) id = add(SurfacePlace::at_vertex(corners[i]));
                triangle[i] = id;
            }
            mesh_.triangles.push_back(triangle);
        }
    }

    Index vertex_at(const SurfacePlace& place) {
        if (const Index v = place.vertex(); v >= 0) return ids_[static_cast<std::size_t>(v)];
        const auto same = std::find_if(places_.begin(), places_.end(), [&](const SurfacePlace& p) {
            return p.corners == place.corners && p.weights == place.weights;
        });
        if (same != places_.end()) return static_cast<Index>(same - places_.begin());
        const Index vertex = add(place);
        // The triangles whose border or inside the place is on: one, or two at an edge.
        for (std::size_t t = mesh_.triangles.size(); t-- > 0;) split(t, vertex, place);
        return vertex;
    }

    [[nodiscard]] const Triangulation& mesh() const { return mesh_; }
    [[nodiscard]] SurfacePlace place(const PathPoint& point) const {
        const auto& a = places_[static_cast<std::size_t>(point.a)];
        return point.a == point.b
                   ? a
                   : between(a, places_[static_cast<std::size_t>(point.b)], point.share);
    }

private:
    Index add(const SurfacePlace& place) {
        places_.push_back(place);
        mesh_.positions.push_back(position_of(surface_, place));
        return static_cast<Index>(places_.size()) - 1;
    }

    /// How much of a corner's triangle lies between the place and the opposite side; the three
    /// shares are weights in the triangle.
    [[nodiscard]] Vec3 shares(const Triangle& t, const SurfacePlace& place) const {
        Eigen::Matrix3d corners;
        Vec3 target;
        const std::vector<Index> rows = rows_of(t, place);
        if (rows.empty()) return Vec3::Constant(-1.0);
        for (Eigen::Index r = 0; r < 3; ++r) {
            const Index row = rows[static_cast<std::size_t>(r)];
            target[r] = place.weight_of(row);
            for (Eigen::Index c = 0; c < 3; ++c)
                corners(r, c) =
                    places_[static_cast<std::size_t>(t[static_cast<std::size_t>(c)])].weight_of(
                        row);
        }
        return corners.partialPivLu().solve(target);
    }
    /// The old face's corners, if the triangle is a part of one that holds the place.
    [[nodiscard]] std::vector<Index> rows_of(const Triangle& t, const SurfacePlace& place) const {
        std::vector<Index> rows;
        for (const Index v : t) {
            for (const Index row : places_[static_cast<std::size_t>(v)].support()) {
                if (!contains(rows, row)) rows.push_back(row);
            }
        }
        const auto support = place.support();
        const bool holds =
            rows.size() == 3 &&
            std::all_of(support.begin(), support.end(), [&](Index v) { return contains(rows, v); });
        return holds ? rows : std::vector<Index>{};
    }

    void split(std::size_t t, Index vertex, const SurfacePlace& place) {
        const Triangle whole = mesh_.triangles[t];
        const Vec3 share = shares(whole, place);
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
    std::vector<SurfacePlace> places_;  ///< per vertex of the mesh
};

}  // namespace

std::vector<SurfacePlace> shortest_paths(const SurfaceMesh& surface,
                                         const std::vector<SurfacePlace>& through) {
    WithPlaces with_places(surface);
    std::vector<Index> stops;
    stops.reserve(through.size());
    for (const SurfacePlace& place : through) stops.push_back(with_places.vertex_at(place));
    const ExactGeodesics geodesics(with_places.mesh());
    std::vector<SurfacePlace> line{through.front()};
    for (std::size_t i = 1; i < stops.size(); ++i) {
        const auto distances = geodesics.from_vertex(stops[i - 1], Progress());
        if (!std::isfinite(distances.distance[static_cast<std::size_t>(stops[i])])) {
            const Vec3 position = position_of(surface, through[i]);
            throw Error(ErrorCode::curve_invalid,
                        "no way leads over the surface to " + place(position))
                .at_position(position);
        }
        const GeodesicPath path = trace_path(geodesics.unfolding(), distances, stops[i]);
        for (std::size_t k = 1; k < path.points.size(); ++k)
            line.push_back(with_places.place(path.points[k]));
    }
    return line;
}

}  // namespace lastflat
