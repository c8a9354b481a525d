#include "core/landmarks/landmarks.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <variant>

#include "core/landmarks/centre_line.h"
#include "core/landmarks/check_outcome.h"
#include "core/landmarks/edge_line.h"
#include "core/landmarks/furthest_pair.h"
#include "core/landmarks/smooth_normals.h"
#include "core/landmarks/sole_and_top.h"
#include "core/locate/surface_search.h"
#include "core/numerics/geometry.h"
#include "core/parallel.h"
#include "core/text.h"

namespace lastflat {
namespace {

/// How far the line reaches to the left and to the right of the plane, at the waist.
std::pair<double, double> waist(const Points3& line, const Vec3& heel, const Vec3& toe,
                                const Vec3& left) {
    const Vec3 way = toe - heel;
    std::pair<double, double> reach{0.0, 0.0};
    int counted_left = 0, counted_right = 0;
    for (const Vec3& p : line) {
        const double share = way.dot(p - heel) / way.squaredNorm();
        if (share < 0.3 || share > 0.55) continue;
        const double off = left.dot(p - heel);
        (off > 0.0 ? reach.first : reach.second) += std::abs(off);
        ++(off > 0.0 ? counted_left : counted_right);
    }
    return {reach.first / std::max(1, counted_left), reach.second / std::max(1, counted_right)};
}

/// A vertex of one side of the upper, far from every curve.
std::optional<Index> vertex_of_side(const SurfaceMesh& surface, const std::vector<bool>& upper,
                                    const std::vector<CurveSource>& curves, const Vec3& origin,
                                    const Vec3& outward) {
    constexpr std::size_t looked_at = 2000, corners = 200;
    Points3 on_curves;
    for (const CurveSource& curve : curves) {
        const Points3& points = points_of(curve);
        for (std::size_t i = 0; i < points.size(); i += points.size() / corners + 1)
            on_curves.push_back(points[i]);
    }
    std::optional<Index> best;
    double furthest = 0.0;
    std::vector<OpenMesh::VertexHandle> vertices;
    for (const auto v : surface.mesh.vertices()) {
        if (!surface.mesh.is_isolated(v)) vertices.push_back(v);
    }
    for (std::size_t i = 0; i < vertices.size(); i += vertices.size() / looked_at + 1) {
        const OpenMesh::VertexHandle vertex = vertices[i];
        const Vec3 at = surface.position(vertex.idx());
        if (outward.dot(at - origin) <= 0.0) continue;
        bool inside = true;
        for (const auto face : surface.mesh.vf_range(vertex))
            inside = inside && upper[static_cast<std::size_t>(face.idx())];
        double distance = std::numeric_limits<double>::infinity();
        for (const Vec3& point : on_curves) distance = std::min(distance, (point - at).norm());
        if (!inside || distance <= furthest) continue;
        furthest = distance;
        best = vertex.idx();
    }
    return best;
}

/// Throws: Error{region_invalid} that lists the pieces with size and place.
void check_one_piece(const SurfaceMesh& surface) {
    constexpr std::size_t most_listed = 8;
    std::vector<bool> left(surface.mesh.n_faces(), true);
    std::size_t count = 0;
    std::string list;
    std::vector<std::size_t> stack;
    for (std::size_t seed = 0; seed < left.size(); ++seed) {
        if (!left[seed]) continue;
        left[seed] = false;
        stack.assign(1, seed);
        Eigen::AlignedBox3d box;
        while (!stack.empty()) {
            const OpenMesh::FaceHandle face(static_cast<int>(stack.back()));
            stack.pop_back();
            for (const Index v : corners_of(surface, face.idx())) box.extend(surface.position(v));
            for (const auto next : surface.mesh.ff_range(face)) {
                if (!left[at(next.idx())]) continue;
                left[at(next.idx())] = false;
                stack.push_back(at(next.idx()));
            }
        }
        if (++count > most_listed) continue;
        const Vec3 size = box.sizes();
        list += (count == 1 ? "" : ", ") + fixed_text(size.x(), 0) + " x " +
                fixed_text(size.y(), 0) + " x " + fixed_text(size.z(), 0) + " mm around " +
                position_text(box.center());
    }
    if (count > 1)
        fail_search("the model is " + std::to_string(count) + " pieces (" + list +
                    (count > most_listed ? ", ..." : "") +
                    "); send one of them, or choose it by surface.groups");
}

void check_surface(const SurfaceMesh& surface) {
    if (is_open(surface)) fail_search("the surface is open");
    check_one_piece(surface);
}

void find_sides(const SurfaceMesh& surface, const std::vector<bool>& upper, const Points3& line,
                Landmarks& found) {
    const Vec3 left = found.up.cross(found.forward).normalized();
    const auto [to_left, to_right] = waist(line, found.heel_point, found.toe_point, left);
    const double difference = (to_right - to_left) / (to_right + to_left);
    found.foot = difference > 0.0 ? Foot::right : Foot::left;
    constexpr double beyond_doubt = 0.2;
    found.sides_confidence = std::min(1.0, std::abs(difference) / beyond_doubt);
    const Vec3 medial = difference > 0.0 ? left : Vec3(-left);
    const auto lateral_vertex =
        vertex_of_side(surface, upper, found.curves, found.heel_point, -medial);
    const auto medial_vertex =
        vertex_of_side(surface, upper, found.curves, found.heel_point, medial);
    if (!lateral_vertex || !medial_vertex) fail_search("the upper has no two sides");
    found.cut.regions = {{region_name::lateral, lateral_vertex},
                         {region_name::medial, medial_vertex}};
}

/// Where an edge fades out, a line is bridged; on a rough surface nobody can tell where it fades.
void doubt_what_fades(Landmarks& found) {
    for (double* confidence : {&found.featherline_confidence, &found.topline_confidence})
        *confidence = std::max(0.0, 1.0 - 2.0 * (1.0 - *confidence));
}

void warn_if_unsure(Landmarks& found) {
    const auto warn = [&](bool sure, double confidence, const char* what, const char* mend) {
        if (sure) return;
        found.warnings.push_back({"landmark_unsure",
                                  std::string("not sure of ") + what + " (confidence " +
                                      std::to_string(confidence).substr(0, 4) + "): " + mend,
                                  std::nullopt});
    };
    for (const auto& [confidence, what] :
         {std::pair(found.featherline_confidence, "the featherline"),
          std::pair(found.topline_confidence, "the topline")})
        warn(confidence >= mostly_sharp, confidence, what,
             "it is not a sharp edge all along; look at it, and send it corrected as a curve");
    warn(found.sides_confidence >= sure_of_sides, found.sides_confidence, "lateral and medial",
         "both sides are much alike; name the regions");
}

/// A sole is a fifth to two fifths of a last, its top a small part.
void check_shares(const std::vector<BareFace>& faces, const SoleAndTop& parts) {
    double all = 0.0, sole = 0.0, top = 0.0;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        all += faces[f].area;
        sole += parts.sole[f] ? faces[f].area : 0.0;
        top += parts.top[f] ? faces[f].area : 0.0;
    }
    if (sole < 0.15 * all || sole > 0.45 * all) fail_search("no side is a sole by its size");
    if (top < 0.003 * all || top > 0.12 * all) fail_search("there is no top of the right size");
}

/// What is found if the last stands as the frame says.
Landmarks found_with(const SurfaceMesh& surface, const std::vector<BareFace>& faces,
                     const LastFrame& frame, TopChoice top, bool noisy) {
    const SoleAndTop parts = sole_and_top(surface, faces, frame, top);
    std::vector<bool> upper(faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f) upper[f] = !parts.sole[f] && !parts.top[f];
    const auto featherline = line_around(surface, parts.sole, curve_name::featherline);
    const auto topline = line_around(surface, parts.top, curve_name::topline);
    Landmarks found;
    auto on_feather = edge_line(surface, faces, curve_name::featherline, featherline, noisy);
    auto on_top = edge_line(surface, faces, curve_name::topline, topline, noisy);
    const bool is_exact = !on_feather.evened && !on_top.evened;
    found.featherline_confidence = on_feather.confidence;
    found.topline_confidence = on_top.confidence;
    found.curves = {std::move(on_feather.curve), std::move(on_top.curve)};
    const SurfaceSearch search(surface);
    for (CurveSource& curve : found.curves) {
        auto& points = std::get<Polyline>(curve.form).points;
        for (Vec3& point : points) point = search.nearest(point).position;
        points.back() = points.front();
    }
    const Points3 line = positions_of(surface, featherline);
    std::tie(found.heel_point, found.toe_point) = furthest_pair(line, frame.forward);
    found.forward = (found.toe_point - found.heel_point).normalized();
    found.up = (frame.up - frame.up.dot(found.forward) * found.forward).normalized();
    check_shares(faces, parts);
    const bool exact = is_exact && found.featherline_confidence >= mostly_sharp &&
                       found.topline_confidence >= mostly_sharp;
    find_centre_line(surface, upper, positions_of(surface, topline), exact, found);
    check_outcome(faces, parts, line, positions_of(surface, topline), found);
    find_sides(surface, upper, line, found);
    found.cut.cuts = {curve_name::featherline, curve_name::topline, curve_name::centre_front,
                      curve_name::heel};
    return found;
}

}  // namespace

const Points3& points_of(const CurveSource& found) {
    return std::get<Polyline>(found.form).points;
}

Landmarks find_landmarks(const SurfaceMesh& surface, const Progress& progress,
                         std::size_t threads) {
    check_surface(surface);
    auto faces = bare_faces(surface);
    constexpr double coarse = 0.05;  // radians from face to face
    const bool noisy = smooth_normals(surface, faces);
    const bool rough = noisy || typical_bend(surface, faces) > coarse;
    std::optional<Landmarks> best;
    std::optional<Error> why;
    const auto sureness = [](const Landmarks& found) {
        return found.featherline_confidence + found.topline_confidence;
    };
    const auto frames = last_frames(faces);
    for (const TopChoice top : {TopChoice::flattest, TopChoice::highest}) {
        if (best && best->topline_confidence >= mostly_sharp) break;
        std::vector<std::variant<std::monostate, Landmarks, Error>> tried(frames.size());
        for_each_index(frames.size(), threads, [&](std::size_t f) {
            progress.check();
            try {
                tried[f] = found_with(surface, faces, frames[f], top, noisy);
            } catch (const Error& error) {
                tried[f] = error;
            }
        });
        for (auto& outcome : tried) {
            if (const auto* error = std::get_if<Error>(&outcome); error != nullptr && !why)
                why = *error;
            auto* found = std::get_if<Landmarks>(&outcome);
            if (found != nullptr && (!best || sureness(*found) > sureness(*best)))
                best = std::move(*found);
        }
    }
    if (!best && !why) fail_search("it has no flat sole");
    if (!best) throw why.value();
    if (rough) doubt_what_fades(*best);
    warn_if_unsure(*best);
    return *best;
}

}  // namespace lastflat
