#include "core/locate/follow_surface.h"

#include <algorithm>
#include <limits>
#include <set>

#include "core/numerics/geometry.h"
#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

Vec3 normal_at(const SurfaceMesh& surface, const SurfacePoint& point) {
    Vec3 sum = Vec3::Zero();
    for (const Index face : faces_at(surface, point))
        sum += doubled_area_vector(surface, corners_of(surface, face)).normalized();
    return sum;
}

/// The plane through two points that stands on the surface.
struct Section {
    Vec3 origin, normal, direction;
    double length;

    [[nodiscard]] double side(const Vec3& p) const { return normal.dot(p - origin); }
    [[nodiscard]] double along(const Vec3& p) const { return direction.dot(p - origin); }
};

/// Where the section meets an edge.
std::optional<SurfacePoint> meeting(const SurfaceMesh& surface, const Section& section, Index a,
                                    Index b) {
    const double side_a = section.side(surface.position(a));
    const double side_b = section.side(surface.position(b));
    if (side_a == side_b || side_a * side_b > 0.0) return std::nullopt;
    const double share = side_a / (side_a - side_b);
    if (share < tolerance::on_edge) return SurfacePoint::at_vertex(a);
    if (share > 1.0 - tolerance::on_edge) return SurfacePoint::at_vertex(b);
    return SurfacePoint::on_edge(a, b, share);
}

/// Whether an edge leads away from a point: one that the point itself is on does not.
bool leads_away(const std::vector<Index>& support, Index a, Index b) {
    if (support.size() == 1) return !contains(support, a) && !contains(support, b);
    return support.size() == 3 || !contains(support, a) || !contains(support, b);
}

/// Where the section leaves the faces at a point that it has not been through; the way that leads
/// furthest along.
std::optional<SurfacePoint> next_point(const SurfaceMesh& surface, const Section& section,
                                       const SurfacePoint& from, std::set<Index>& been) {
    const std::vector<Index> support = from.support();
    std::optional<SurfacePoint> best;
    Index through = -1;
    double furthest = -std::numeric_limits<double>::infinity();
    for (const Index face : faces_at(surface, from)) {
        if (been.contains(face)) continue;
        const Triangle corners = corners_of(surface, face);
        for (std::size_t i = 0; i < 3; ++i) {
            const Index a = corners[i], b = corners[(i + 1) % 3];
            if (!leads_away(support, a, b)) continue;
            const auto point = meeting(surface, section, a, b);
            if (!point || section.along(position_of(surface, *point)) <= furthest) continue;
            furthest = section.along(position_of(surface, *point));
            best = point;
            through = face;
        }
    }
    been.insert(through);
    return best;
}

/// The border's half-edge that a point is on.
std::optional<OpenMesh::HalfedgeHandle> border_at(const SurfaceMesh& surface,
                                                  const SurfacePoint& point) {
    const std::vector<Index> support = point.support();
    for (const auto h : surface.mesh.voh_range(OpenMesh::VertexHandle(support.front()))) {
        for (const auto side :
             {OpenMesh::HalfedgeHandle(h),
              OpenMesh::HalfedgeHandle(surface.mesh.opposite_halfedge_handle(h))}) {
            if (!surface.mesh.is_boundary(side)) continue;
            const Index from = surface.mesh.from_vertex_handle(side).idx();
            const Index to = surface.mesh.to_vertex_handle(side).idx();
            if (std::all_of(support.begin(), support.end(),
                            [&](Index v) { return v == from || v == to; }))
                return side;
        }
    }
    return std::nullopt;
}

/// Along the border, if both points are on it and the way is not much longer than the straight one.
bool slide(const SurfaceMesh& surface, const SurfacePoint& to, std::vector<SurfacePoint>& line) {
    const auto begin = border_at(surface, line.back()), end = border_at(surface, to);
    if (!begin || !end) return false;
    constexpr double longest = 1.25;  // of the straight way
    const Vec3 from = position_of(surface, line.back()), target = position_of(surface, to);
    const double most = longest * (target - from).norm();
    for (const bool forward : {true, false}) {
        std::vector<SurfacePoint> way;
        Vec3 at = from;
        double length = 0.0;
        OpenMesh::HalfedgeHandle h = *begin;
        while (length <= most &&
               !share_a_face(surface, way.empty() ? line.back() : way.back(), to)) {
            const auto vertex =
                forward ? surface.mesh.to_vertex_handle(h) : surface.mesh.from_vertex_handle(h);
            const Vec3 next = surface.position(vertex.idx());
            length += (next - at).norm();
            at = next;
            if (way.empty() ? line.back().vertex() != vertex.idx() : true)
                way.push_back(SurfacePoint::at_vertex(vertex.idx()));
            h = forward ? surface.mesh.next_halfedge_handle(h)
                        : surface.mesh.prev_halfedge_handle(h);
        }
        if (length + (target - at).norm() > most) continue;
        line.insert(line.end(), way.begin(), way.end());
        line.push_back(to);
        return true;
    }
    return false;
}

constexpr double longest_way = 1.1;  ///< of the straight one
/// So far before its beginning and beyond its end, as a share of its length, a section may go:
/// surfaces have folds.
constexpr double slack = 0.1;

bool walk(const SurfaceMesh& surface, const SurfacePoint& to, std::vector<SurfacePoint>& line) {
    if (slide(surface, to, line)) return true;
    const Vec3 begin = position_of(surface, line.back()), end = position_of(surface, to);
    const Vec3 way = end - begin;
    if (way.norm() == 0.0) return share_a_face(surface, line.back(), to);
    const Vec3 normal =
        way.cross(normal_at(surface, line.back()) + normal_at(surface, to)).normalized();
    if (!normal.allFinite()) return false;
    const Section section{begin, normal, way.normalized(), way.norm()};
    std::vector<SurfacePoint> way_points;
    SurfacePoint at = line.back();
    std::set<Index> been;
    double length = 0.0;
    while (!share_a_face(surface, at, to)) {
        const auto next = next_point(surface, section, at, been);
        if (!next) return false;
        const Vec3 position = position_of(surface, *next);
        length += (position - position_of(surface, at)).norm();
        const double along = section.along(position);
        const bool lost = length > longest_way * section.length ||
                          along < -slack * section.length || along > (1.0 + slack) * section.length;
        if (lost) return false;
        way_points.push_back(*next);
        at = *next;
    }
    line.insert(line.end(), way_points.begin(), way_points.end());
    line.push_back(to);
    return true;
}

bool follow(const SurfaceSearch& search, const SurfaceMesh& surface, const SurfacePoint& to,
            std::vector<SurfacePoint>& line, int depth) {
    if (walk(surface, to, line)) return true;
    if (depth == 0) return false;
    const Vec3 middle = 0.5 * (position_of(surface, line.back()) + position_of(surface, to));
    const SurfacePoint between = search.nearest(middle).point;
    return follow(search, surface, between, line, depth - 1) &&
           follow(search, surface, to, line, depth - 1);
}

}  // namespace

bool follow_surface(const SurfaceSearch& search, const SurfaceMesh& surface, const SurfacePoint& to,
                    std::vector<SurfacePoint>& line) {
    constexpr int most_halvings = 8;
    const std::size_t before = line.size();
    if (follow(search, surface, to, line, most_halvings)) return true;
    line.resize(before);
    return false;
}

}  // namespace lastflat
