#include "core/cut/insert_curves.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "core/numerics/geometry.h"
#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

using VertexHandle = OpenMesh::VertexHandle;
using FaceHandle = OpenMesh::FaceHandle;
using HalfedgeHandle = OpenMesh::HalfedgeHandle;

/// A face as it was before any line came, laid into the plane.
struct FlatFace {
    Triangle corners;
    std::array<Vec2, 3> flat;
    double snap;  ///< mm

    [[nodiscard]] Vec2 at(const SurfacePoint& point) const {
        Vec2 sum = Vec2::Zero();
        for (std::size_t i = 0; i < 3; ++i) sum += point.weight_of(corners[i]) * flat[i];
        return sum;
    }
};

class Insertion {
public:
    explicit Insertion(SurfaceMesh& surface)
        : mesh_(surface.mesh), surface_(surface), old_vertices_(mesh_.n_vertices()) {
        for (const auto face : mesh_.faces()) {
            faces_.push_back(corners_of(surface, face.idx()));
            old_face_.push_back(face.idx());
        }
    }

    void add(const SurfaceLine& line) {
        const std::size_t number = curves_.size();
        snap_ = line.snap;
        const std::size_t last = line.points.size() - 1;
        const auto vertex_of = [&](std::size_t i, Index face) {
            const bool on_line = i == 0 ? line.starts_on_line : i == last && line.ends_on_line;
            const Index found = on_line && face >= 0 ? vertex_on_line(line.points[i], face) : -1;
            return found >= 0 ? found : vertex_at(line.points[i]);
        };
        const Index first_face = last > 0 ? common_face(line.points[0], line.points[1]) : Index{-1};
        std::vector<Index> path{vertex_of(0, first_face)};
        for (std::size_t i = 1; i <= last; ++i) {
            const Index face = common_face(line.points[i - 1], line.points[i]);
            const Index to = vertex_of(i, face);
            if (face < 0 || to == path.back()) continue;
            connect(flat(face), face, to, path);
        }
        check_simple(line, path);
        curves_.push_back({line.name, path});
        for (std::size_t i = 1; i < path.size(); ++i)
            users_[std::minmax(path[i - 1], path[i])].insert(number);
    }

    /// The surface's new faces take over the origins of those that they are parts of.
    InsertedCurves finish(SurfaceMesh& surface) {
        std::vector<FaceOrigin> origins;
        for (const Index old : old_face_) origins.push_back(surface.origins[at(old)]);
        surface.origins = std::move(origins);
        return {std::move(curves_), std::move(added_), smallest_angle()};
    }

private:
    [[nodiscard]] SurfacePoint point_of(Index vertex) const {
        const auto v = static_cast<std::size_t>(vertex);
        return v < old_vertices_ ? SurfacePoint::at_vertex(vertex) : added_[v - old_vertices_];
    }
    [[nodiscard]] Index old_face(FaceHandle face) const {
        return old_face_[static_cast<std::size_t>(face.idx())];
    }
    [[nodiscard]] const Triangle& old_corners(Index face) const {
        return faces_[static_cast<std::size_t>(face)];
    }

    [[nodiscard]] FlatFace flat(Index face) const {
        const Triangle& t = old_corners(face);
        const Vec3 a = surface_.position(t[0]), b = surface_.position(t[1]),
                   c = surface_.position(t[2]);
        const auto [length, apex] = laid_flat(a, b, c);
        const double longest = std::max({length, (c - a).norm(), (c - b).norm()});
        return {t, {Vec2(0.0, 0.0), Vec2(length, 0.0), apex}, snap_ * longest};
    }

    /// The old faces around an old vertex, as far as they can be seen from their parts.
    [[nodiscard]] std::vector<Index> faces_around(Index vertex) const {
        std::vector<Index> found;
        for (const auto face : mesh_.vf_range(VertexHandle(vertex)))
            found.push_back(old_face(face));
        std::sort(found.begin(), found.end());
        found.erase(std::unique(found.begin(), found.end()), found.end());
        return found;
    }

    /// An old face that holds both points; -1: they are one point, or there is none.
    [[nodiscard]] Index common_face(const SurfacePoint& a, const SurfacePoint& b) const {
        std::vector<Index> support = a.support();
        for (const Index v : b.support()) support.push_back(v);
        for (const Index face : faces_around(support.front())) {
            const Triangle& t = old_corners(face);
            if (std::all_of(support.begin(), support.end(),
                            [&](Index v) { return contains(t, v); }))
                return face;
        }
        return -1;
    }

    /// The current faces that an old one has become.
    [[nodiscard]] std::vector<FaceHandle> parts(Index face) const {
        const auto found = parts_.find(face);
        if (found == parts_.end()) return {FaceHandle(face)};
        return found->second;
    }

    /// Whether a point is on the edge that another is on; inside a face everything is.
    [[nodiscard]] static bool lies_within(const SurfacePoint& point, const SurfacePoint& other) {
        const auto support = other.support();
        if (support.size() == 3) return true;
        const auto own = point.support();
        return std::all_of(own.begin(), own.end(), [&](Index v) { return contains(support, v); });
    }

    /// The vertex at a point, made if there is none. A point on an old edge stays on it: the next
    /// face knows nothing of what is inside this one.
    Index vertex_at(const SurfacePoint& point) {
        if (const Index vertex = point.vertex(); vertex >= 0) return vertex;
        const Index face = common_face(point, point);
        const FlatFace plane = flat(face);
        const Vec2 flat_point = plane.at(point);
        HalfedgeHandle nearest_edge;
        double edge_distance = plane.snap, share = 0.0;
        FaceHandle holder;
        double depth = -std::numeric_limits<double>::infinity();
        for (const FaceHandle part : parts(face)) {
            double inside = std::numeric_limits<double>::infinity();
            for (const auto h : mesh_.fh_range(part)) {
                const Index a = mesh_.from_vertex_handle(h).idx(),
                            b = mesh_.to_vertex_handle(h).idx();
                if (!lies_within(point_of(a), point)) continue;
                const Vec2 from = plane.at(point_of(a)), along = plane.at(point_of(b)) - from;
                if ((flat_point - from).norm() <= plane.snap) return a;
                const bool on_line = lies_within(point_of(b), point);
                const double at = along.dot(flat_point - from) / along.squaredNorm();
                const double off = cross(along, flat_point - from) / along.norm();
                inside = std::min(inside, off);
                if (!on_line || at <= 0.0 || at >= 1.0 || std::abs(off) > edge_distance) continue;
                edge_distance = std::abs(off);
                nearest_edge = h;
                share = at;
            }
            if (inside > depth) {
                depth = inside;
                holder = part;
            }
        }
        if (nearest_edge.is_valid()) return split_edge(nearest_edge, share);
        return split_face(holder, point);
    }

    /// The vertex of a line that runs through an old face by the point, made if there is none; -1:
    /// no line is there. That line may have been put on vertices and edges beside the point.
    Index vertex_on_line(const SurfacePoint& point, Index face) {
        const FlatFace plane = flat(face);
        const Vec2 flat_point = plane.at(point);
        HalfedgeHandle nearest;
        double least = tolerance::drawn_snap / snap_ * plane.snap, share = 0.0;
        for (const FaceHandle part : parts(face)) {
            for (const auto h : mesh_.fh_range(part)) {
                const Index a = mesh_.from_vertex_handle(h).idx(),
                            b = mesh_.to_vertex_handle(h).idx();
                if (!users_.contains(std::minmax(a, b))) continue;
                const Vec2 from = plane.at(point_of(a)), along = plane.at(point_of(b)) - from;
                const double at =
                    std::clamp(along.dot(flat_point - from) / along.squaredNorm(), 0.0, 1.0);
                const double distance = (from + at * along - flat_point).norm();
                if (distance > least) continue;
                least = distance;
                nearest = h;
                share = at * along.norm() <= plane.snap           ? 0.0
                        : (1.0 - at) * along.norm() <= plane.snap ? 1.0
                                                                  : at;
            }
        }
        if (!nearest.is_valid()) return -1;
        if (share == 0.0) return mesh_.from_vertex_handle(nearest).idx();
        if (share == 1.0) return mesh_.to_vertex_handle(nearest).idx();
        return split_edge(nearest, share);
    }

    Index add_vertex(const Vec3& position, const SurfacePoint& point) {
        added_.push_back(point);
        return mesh_.add_vertex({position.x(), position.y(), position.z()}).idx();
    }

    /// Files the faces around a new vertex under the old face of the part that they come from.
    void file_faces(Index vertex, const std::map<Index, Index>& old_face_by_apex) {
        old_face_.resize(mesh_.n_faces(), -1);
        for (const auto face : mesh_.vf_range(VertexHandle(vertex))) {
            Index old = -1;
            for (const auto v : mesh_.fv_range(face)) {
                if (const auto found = old_face_by_apex.find(v.idx());
                    found != old_face_by_apex.end())
                    old = found->second;
            }
            old_face_[static_cast<std::size_t>(face.idx())] = old;
            auto& list =
                parts_.try_emplace(old, std::vector<FaceHandle>{FaceHandle(old)}).first->second;
            if (!contains(list, face)) list.push_back(face);
            touched_.insert(face.idx());
        }
    }

    Index split_face(FaceHandle face, const SurfacePoint& point) {
        std::map<Index, Index> old;
        for (const auto v : mesh_.fv_range(face)) old[v.idx()] = old_face(face);
        const Index vertex = add_vertex(position_of(surface_, point), point);
        mesh_.split(face, VertexHandle(vertex));
        file_faces(vertex, old);
        return vertex;
    }

    Index split_edge(HalfedgeHandle edge, double share) {
        const Index a = mesh_.from_vertex_handle(edge).idx(),
                    b = mesh_.to_vertex_handle(edge).idx();
        std::map<Index, Index> old;
        for (const auto h : {edge, mesh_.opposite_halfedge_handle(edge)}) {
            if (mesh_.is_boundary(h)) continue;
            old[mesh_.to_vertex_handle(mesh_.next_halfedge_handle(h)).idx()] =
                old_face(mesh_.face_handle(h));
        }
        const Vec3 from = surface_.position(a), to = surface_.position(b);
        const Index vertex =
            add_vertex(from + share * (to - from), between(point_of(a), point_of(b), share));
        mesh_.split(mesh_.edge_handle(edge), VertexHandle(vertex));
        file_faces(vertex, old);
        const auto users = users_.find(std::minmax(a, b));
        if (users == users_.end()) return vertex;
        const std::set<std::size_t> numbers = users->second;
        users_.erase(users);
        for (const std::size_t number : numbers) put_between(number, a, vertex, b);
        return vertex;
    }

    void put_between(std::size_t number, Index a, Index vertex, Index b) {
        auto& path = curves_[number].vertices;
        for (std::size_t i = 1; i < path.size(); ++i) {
            if (std::minmax(path[i - 1], path[i]) != std::minmax(a, b)) continue;
            path.insert(path.begin() + static_cast<std::ptrdiff_t>(i), vertex);
            ++i;
        }
        users_[std::minmax(a, vertex)].insert(number);
        users_[std::minmax(vertex, b)].insert(number);
    }

    /// Extends the path by straight steps inside an old face until it ends at `to`.
    void connect(const FlatFace& plane, Index face, Index to, std::vector<Index>& path) {
        constexpr int most_steps = 100'000;
        for (int step = 0; path.back() != to && step < most_steps; ++step) {
            const Index at = path.back();
            if (mesh_.find_halfedge(VertexHandle(at), VertexHandle(to)).is_valid()) {
                extend(path, to);
                return;
            }
            const Index next = step_towards(plane, face, at, to);
            if (next < 0) break;
            extend(path, next);
        }
        if (path.back() != to)
            throw Error(ErrorCode::curve_invalid, "a curve cannot be put into the faces at " +
                                                      position_text(surface_.position(to)))
                .at_position(surface_.position(to));
    }

    /// What was put on vertices may turn back on itself: such a spike has no length.
    static void extend(std::vector<Index>& path, Index vertex) {
        if (path.size() > 1 && path[path.size() - 2] == vertex)
            path.pop_back();
        else
            path.push_back(vertex);
    }

    Index step_towards(const FlatFace& plane, Index face, Index at, Index to) {
        const Vec2 here = plane.at(point_of(at)), way = plane.at(point_of(to)) - here;
        const double length = way.norm();
        for (const auto h : mesh_.voh_range(VertexHandle(at))) {
            if (mesh_.is_boundary(h) || old_face(mesh_.face_handle(h)) != face) continue;
            const auto across = mesh_.next_halfedge_handle(h);
            const Index a = mesh_.from_vertex_handle(across).idx(),
                        b = mesh_.to_vertex_handle(across).idx();
            const Vec2 to_a = plane.at(point_of(a)) - here, to_b = plane.at(point_of(b)) - here;
            for (const auto& [v, arm] : {std::pair(a, to_a), std::pair(b, to_b)}) {
                if (std::abs(cross(way, arm)) <= plane.snap * length && way.dot(arm) > 0.0 &&
                    arm.norm() < length)
                    return v;
            }
            const double side_a = cross(way, to_a), side_b = cross(way, to_b);
            if (!(side_a < 0.0 && side_b > 0.0)) continue;
            return split_edge(across, side_a / (side_a - side_b));
        }
        return -1;
    }

    void check_simple(const SurfaceLine& line, const std::vector<Index>& path) const {
        const auto fail = [&](const std::string& what, Index vertex) {
            throw Error(ErrorCode::curve_invalid, "curve '" + line.name + "' " + what + ", at " +
                                                      position_text(surface_.position(vertex)))
                .at_option({"curves", line.name})
                .at_position(surface_.position(vertex));
        };
        if (path.size() < 2) fail("has no length", path.front());
        std::set<Index> seen;
        for (std::size_t i = 0; i < path.size(); ++i) {
            const bool closes = i + 1 == path.size() && i > 2 && path[i] == path.front();
            if (!seen.insert(path[i]).second && !closes) fail("meets itself", path[i]);
        }
    }

    [[nodiscard]] double smallest_angle() const {
        double least = std::numbers::pi;
        for (const Index face : touched_) {
            const Triangle t = corners_of(surface_, face);
            for (std::size_t i = 0; i < 3; ++i) {
                const Vec3 a = surface_.position(t[(i + 1) % 3]) - surface_.position(t[i]);
                const Vec3 b = surface_.position(t[(i + 2) % 3]) - surface_.position(t[i]);
                least = std::min(least, angle_between(a, b));
            }
        }
        return least;
    }

    TriMesh& mesh_;
    const SurfaceMesh& surface_;
    const std::size_t old_vertices_;
    double snap_ = 0.0;            ///< of the line at hand
    std::vector<Triangle> faces_;  ///< the old ones' corners
    std::vector<Index> old_face_;  ///< per current face
    std::map<Index, std::vector<FaceHandle>> parts_;
    std::vector<SurfacePoint> added_;
    Curves curves_;
    std::map<std::pair<Index, Index>, std::set<std::size_t>> users_;  ///< curves along an edge
    std::set<Index> touched_;
};

/// A point on vertices of which those from `first` on are points themselves, all in one old face.
SurfacePoint on_old_vertices(const SurfacePoint& point, Index first,
                             const std::vector<SurfacePoint>& added) {
    std::map<Index, double> weights;
    for (const Index corner : point.support()) {
        const double share = point.weight_of(corner);
        const SurfacePoint part = corner < first ? SurfacePoint::at_vertex(corner)
                                                 : added[static_cast<std::size_t>(corner - first)];
        for (const Index old : part.support()) weights[old] += share * part.weight_of(old);
    }
    SurfacePoint sum;
    sum.corners.fill(weights.begin()->first);
    std::size_t i = 0;
    for (const auto& [corner, weight] : weights) {
        sum.corners.at(i) = corner;
        sum.weights[static_cast<Eigen::Index>(i++)] = weight;
    }
    return sum;
}

}  // namespace

InsertedCurves insert_curves(SurfaceMesh& surface, const std::vector<SurfaceLine>& lines) {
    Insertion insertion(surface);
    for (const SurfaceLine& line : lines) insertion.add(line);
    return insertion.finish(surface);
}

InsertedCurves insert_more_curves(SurfaceMesh& surface, InsertedCurves before,
                                  const std::vector<SurfaceLine>& lines) {
    const auto first = static_cast<Index>(surface.mesh.n_vertices() - before.added.size());
    std::vector<SurfaceLine> all;
    for (const Curve& curve : before.curves) {
        all.push_back({curve.name, {}});
        for (const Index v : curve.vertices)
            all.back().points.push_back(SurfacePoint::at_vertex(v));
    }
    all.insert(all.end(), lines.begin(), lines.end());
    InsertedCurves inserted = insert_curves(surface, all);
    for (const SurfacePoint& point : inserted.added)
        before.added.push_back(on_old_vertices(point, first, before.added));
    inserted.added = std::move(before.added);
    inserted.smallest_angle = std::min(inserted.smallest_angle, before.smallest_angle);
    return inserted;
}

}  // namespace lastflat
