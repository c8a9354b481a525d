#include "core/plan/close_opening.h"

#include <algorithm>
#include <limits>
#include <numbers>
#include <optional>

#include "core/error.h"
#include "core/landmarks/landmarks.h"
#include "core/numerics/geometry.h"
#include "core/numerics/least_area.h"
#include "core/text.h"
#include "core/weld/unit_of.h"

namespace lastflat {
namespace {

/// More is no last's, and the triangulation takes the cube of a rim's vertices.
constexpr std::size_t most_vertices = 1024;
/// So near to the line found a rim lies, as a share of the last's length.
constexpr double rim_reach = 0.02;

/// As the hole's own half-edges run, so that new faces fit.
std::vector<std::vector<OpenMesh::VertexHandle>> rims_of(const TriMesh& mesh) {
    std::vector<std::vector<OpenMesh::VertexHandle>> rims;
    std::vector<bool> seen(mesh.n_halfedges(), false);
    for (const auto start : mesh.halfedges()) {
        if (!mesh.is_boundary(start) || seen[at(start.idx())]) continue;
        rims.emplace_back();
        OpenMesh::HalfedgeHandle h = start;
        do {
            seen[at(h.idx())] = true;
            rims.back().push_back(mesh.from_vertex_handle(h));
            h = mesh.next_halfedge_handle(h);
        } while (h != start);
    }
    return rims;
}

Points3 positions_of(const SurfaceMesh& surface, const std::vector<OpenMesh::VertexHandle>& rim) {
    Points3 positions;
    for (const auto v : rim) positions.push_back(surface.position(v.idx()));
    return positions;
}

void fill(SurfaceMesh& surface, const std::vector<OpenMesh::VertexHandle>& rim) {
    const auto beside =
        surface.mesh.opposite_halfedge_handle(surface.mesh.find_halfedge(rim[0], rim[1]));
    const FaceOrigin origin =
        surface.origins[at(surface.mesh.face_handle(beside).idx())].filling_beside();
    const auto filling =
        least_area_triangles(positions_of(surface, rim), [&](std::size_t i, std::size_t j) {
            return surface.mesh.find_halfedge(rim[i], rim[j]).is_valid();
        });
    for (const Triangle& t : filling) {
        surface.mesh.add_face(rim[at(t[0])], rim[at(t[1])], rim[at(t[2])]);
        surface.origins.push_back(origin);
    }
}

/// How far the rim comes away from the line's points and the middles between them.
double furthest_from(const Points3& line, const Points3& rim) {
    double furthest = 0.0;
    for (const Vec3& p : rim) {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < line.size(); ++i) {
            least = std::min(least, (line[i] - p).norm());
            if (i > 0) least = std::min(least, (0.5 * (line[i] + line[i - 1]) - p).norm());
        }
        furthest = std::max(furthest, least);
    }
    return furthest;
}

/// The line of the last that a rim is.
std::optional<std::string> line_at(const Landmarks& found, const Points3& rim) {
    const double length = (found.toe_point - found.heel_point).norm();
    for (const CurveSource& curve : found.curves) {
        if (curve.name != curve_name::topline && curve.name != curve_name::featherline) continue;
        if (furthest_from(points_of(curve), rim) < rim_reach * length) return curve.name;
    }
    return std::nullopt;
}

/// Whether a flat piece with such a border has not half the surface's area.
bool is_too_short(const SurfaceMesh& surface, double length) {
    double area = 0.0;
    for (const auto face : surface.mesh.faces())
        area += 0.5 * doubled_area_vector(surface, corners_of(surface, face.idx())).norm();
    return length * length < 2.0 * std::numbers::pi * area;
}

[[noreturn]] void refuse_hole(const Points3& rim, double length) {
    Vec3 middle = Vec3::Zero();
    for (const Vec3& p : rim) middle += p / static_cast<double>(rim.size());
    throw Error(ErrorCode::region_invalid,
                "the last has a hole around " + position_text(middle) + ", " +
                    fixed_text(length, 0) +
                    " mm around, that is neither its top nor its sole; close it in the model, or "
                    "name the curves, cuts and regions. \"holes\": \"keep\" flattens the surface "
                    "as it is")
        .at_option({"holes"})
        .at_position(middle);
}

}  // namespace

void close_opening(SurfaceMesh& surface, const Request& request) {
    if (says_how_to_cut(request) || !request.curves.empty()) return;
    const auto rims = rims_of(surface.mesh);
    if (rims.size() != 1 || rims.front().size() > most_vertices) return;
    const auto& rim = rims.front();
    SurfaceMesh closed = surface;
    fill(closed, rim);
    Landmarks found;
    try {
        found = find_landmarks(closed);
    } catch (const Error& error) {
        if (error.code() != ErrorCode::region_invalid) throw;
        return;  // no last
    }
    const double length_mm = (found.toe_point - found.heel_point).norm();
    if (length_mm < shortest_infant_mm || length_mm > longest_last_mm) return;
    const Points3 points = positions_of(surface, rim);
    const double length = length_of(points) + (points.back() - points.front()).norm();
    const auto line = line_at(found, points);
    if (!line) {
        if (request.cut.holes == HoleRule::automatic && is_too_short(surface, length))
            refuse_hole(points, length);
        return;
    }
    closed.repairs.push_back(
        {"opening_closed",
         "the rim of " + fixed_text(length, 1) + " mm was taken as the " + *line,
         1,
         {points.front()},
         {length}});
    surface = std::move(closed);
}

}  // namespace lastflat
