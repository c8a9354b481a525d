#include "core/weld/weld.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <set>

#include "core/numerics/disjoint_sets.h"
#include "core/numerics/geometry.h"
#include "core/numerics/tolerances.h"
#include "core/text.h"
#include "core/weld/check_manifold.h"
#include "core/weld/close_holes.h"
#include "core/weld/fins.h"
#include "core/weld/inner_shells.h"
#include "core/weld/joined_seams.h"
#include "core/weld/merge_vertices.h"
#include "core/weld/split_fans.h"
#include "core/weld/stitch.h"
#include "core/weld/unit_of.h"

namespace lastflat {
namespace {

std::string known_groups(const RawMesh& raw) {
    std::set<std::string> names;
    for (const auto& labels : raw.label_sets) names.insert(labels.begin(), labels.end());
    if (names.empty()) return "the model has no named groups";
    std::string text = "the model has";
    std::size_t listed = 0;
    for (const auto& name : names) {
        if (++listed > 12) return text + " ...";
        text += (listed == 1 ? " '" : ", '") + name + "'";
    }
    return text;
}

/// Per label set, whether its faces take part.
std::vector<bool> selected_labels(const RawMesh& raw, const std::vector<std::string>& groups) {
    if (groups.empty()) return std::vector<bool>(raw.label_sets.size(), true);
    std::vector<bool> wanted(raw.label_sets.size(), false);
    for (std::size_t g = 0; g < groups.size(); ++g) {
        bool found = false;
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            const auto& labels = raw.label_sets[i];
            if (!contains(labels, groups[g])) continue;
            wanted[i] = found = true;
        }
        if (!found) {
            throw Error(ErrorCode::group_not_found,
                        "group '" + groups[g] + "' does not exist: " + known_groups(raw))
                .at_option({"surface", "groups", std::to_string(g)});
        }
    }
    return wanted;
}

void check_shapes(const Faces& faces) {
    for (const Triangle& t : faces.triangles) {
        // Negated, so that what is no number is caught as well.
        if (!(height_share(faces, t) > tolerance::degenerate_height)) {
            throw Error(ErrorCode::mesh_degenerate, "triangle " + std::to_string(t[0]) + " " +
                                                        std::to_string(t[1]) + " " +
                                                        std::to_string(t[2]) + " has no area, at " +
                                                        position_text(faces.position(t[0])) +
                                                        "; remove it or mend the mesh there")
                .at_position(faces.position(t[0]));
        }
    }
}

void check_coordinates(const Points3& positions) {
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const Vec3& p = positions[v];
        if (p.allFinite() && p.cwiseAbs().maxCoeff() <= tolerance::largest_coordinate_mm) continue;
        throw Error(ErrorCode::mesh_degenerate,
                    "vertex " + std::to_string(v) +
                        " lies more than a kilometre away; are the units right?")
            .at_option({"units"});
    }
}

double signed_volume(const Points3& positions, const std::vector<Triangle>& triangles) {
    double volume = 0.0;
    const Vec3 origin = positions[static_cast<std::size_t>(triangles.front()[0])];
    for (const Triangle& t : triangles) {
        const auto at = [&](std::size_t i) -> Vec3 {
            return positions[static_cast<std::size_t>(t[i])] - origin;
        };
        volume += at(0).dot(at(1).cross(at(2))) / 6.0;
    }
    return volume;
}

bool joins_coincident(const RawMesh& raw, const WeldOptions& options) {
    if (options.coincident) return *options.coincident == Coincident::join;
    return options.tolerance_mm || !raw.indexed || raw.repeats_at_seams;
}

void merge_coincident(const RawMesh& raw, const WeldOptions& options, Faces& faces,
                      std::vector<Repair>& repairs) {
    if (!joins_coincident(raw, options)) {
        faces.welded_to = each_for_itself(faces.positions.size());
        return;
    }
    const double round_off = raw.indexed ? 0.0 : tolerance::same_position * size_of(faces);
    faces.welded_to = merge_vertices(faces.positions, options.tolerance_mm.value_or(round_off));
    faces.rename();
    if (raw.indexed) list_joined_seams(raw.triangles, faces, repairs);
}

/// A model without indices has a vertex for every corner: those count that merging leaves.
void check_size(const RawMesh& raw, const Faces& faces, const LoadLimits& limits) {
    if (raw.indexed) return;
    std::size_t vertices = 0;
    for (std::size_t v = 0; v < faces.welded_to.size(); ++v)
        vertices += faces.welded_to[v] == static_cast<Index>(v) ? 1 : 0;
    if (vertices > limits.vertices)
        throw Error(ErrorCode::model_too_large, std::to_string(vertices) +
                                                    " vertices after welding; at most " +
                                                    std::to_string(limits.vertices) + " are read");
}

std::size_t count_pieces(const Faces& faces) {
    DisjointSets pieces(faces.positions.size());
    std::set<Index> roots;
    for (const Triangle& t : faces.triangles) {
        pieces.join(t[0], t[1]);
        pieces.join(t[0], t[2]);
    }
    for (const Triangle& t : faces.triangles) roots.insert(pieces.find(t[0]));
    return roots.size();
}

/// Leaves at most two faces at every edge and one fan at every vertex, as far as that can be told.
/// `sound`: triangles that need it not; those of which that is found.
void make_manifold(Faces& faces, std::vector<Repair>& repairs, std::vector<Triangle>& sound) {
    if (faces.triangles == sound) return;
    sound = faces.triangles;
    wind_alike(faces, repairs);
    drop_fins(faces, repairs);
    split_fans(faces);
    if (faces.triangles != sound) sound.clear();
}

void stitch_borders(double tolerance, Faces& faces, std::vector<Repair>& repairs) {
    stitch(faces, tolerance, repairs);
    clean_faces(faces, repairs);
    std::vector<Triangle> sound;
    make_manifold(faces, repairs, sound);
}

/// Several pieces that stitching makes one model, closed but for small holes, were meant as one,
/// and so was one whose slits it closes, unless its slits are meant; a pair of flat halves was not.
void close_borders(const WeldOptions& options, HoleRule holes, bool keeps_slits, Faces& faces,
                   std::vector<Repair>& repairs) {
    if (options.stitch_mm) {
        if (*options.stitch_mm > 0.0) stitch_borders(*options.stitch_mm, faces, repairs);
        return;
    }
    if (is_closed(faces.sides())) return;
    const bool closes_holes = holes == HoleRule::automatic;
    const bool only_slits = keeps_slits && count_pieces(faces) < 2;
    if (only_slits && !(closes_holes && has_only_small_holes(faces))) return;
    Faces closed = faces;
    std::vector<Repair> done = repairs;
    stitch_borders(tolerance::near_border * size_of(faces), closed, done);
    if (closes_holes) close_small_holes(closed, done);
    if (!is_closed(closed.sides())) return;
    faces = std::move(closed);
    repairs = std::move(done);
}

/// Of pieces that a wider stitch would make one closed model, which one.
void warn_of_gaps(const WeldOptions& options, const Faces& faces, std::vector<Warning>& warnings) {
    if (options.stitch_mm || is_closed(faces.sides())) return;
    const std::size_t pieces = count_pieces(faces);
    constexpr std::size_t most_pieces = 100;
    if (pieces < 2 || pieces > most_pieces) return;
    for (const double wider : {1.0, 2.0}) {
        if (wider <= tolerance::near_border * size_of(faces)) continue;
        Faces closed = faces;
        std::vector<Repair> done;
        stitch_borders(wider, closed, done);
        if (closed.triangles.empty() || !is_closed(closed.sides()) || count_pieces(closed) > 1)
            continue;
        warnings.push_back({"gaps_left",
                            "the model is " + std::to_string(pieces) +
                                " pieces with gaps between them; \"weld\": {\"stitch_mm\": " +
                                general_text(wider, 2) + "} makes it one closed surface",
                            std::nullopt});
        return;
    }
}

void turn_outward(Faces& faces, std::vector<Repair>& repairs) {
    if (!is_closed(faces.sides()) || signed_volume(faces.positions, faces.triangles) >= 0.0) return;
    for (Triangle& t : faces.triangles) std::swap(t[1], t[2]);
    repairs.push_back({"orientation_reversed",
                       "all faces of the closed model point inward; they were turned",
                       faces.triangles.size()});
}

/// The faces that take part go into the surface; of the others the labels along its border stay.
void select_faces(const RawMesh& raw, const WeldOptions& options, Faces& faces,
                  SurfaceMesh& surface) {
    const std::vector<bool> wanted = selected_labels(raw, options.groups);
    Faces chosen{faces.positions, {}, {}, faces.welded_to, faces.copies};
    for (std::size_t t = 0; t < faces.triangles.size(); ++t) {
        const Triangle& triangle = faces.triangles[t];
        if (wanted[faces.origins[t].label]) {
            chosen.triangles.push_back(triangle);
            chosen.origins.push_back(faces.origins[t]);
        } else {
            for (std::size_t i = 0; i < 3; ++i)
                surface.labels_beyond[{triangle[i], triangle[(i + 1) % 3]}] =
                    faces.origins[t].label;
        }
    }
    surface.label_sets = raw.label_sets;
    faces = std::move(chosen);
}

/// Where what was chosen touches itself it is parted; the labels beyond its border stay.
void split_chosen(Faces& faces, SurfaceMesh& surface) {
    const std::vector<Triangle> whole = faces.triangles;
    split_fans(faces);
    for (std::size_t t = 0; t < whole.size(); ++t) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3;  // the half-edge beyond runs from j to i
            const auto label = surface.labels_beyond.find({whole[t][j], whole[t][i]});
            if (label == surface.labels_beyond.end()) continue;
            surface.labels_beyond[{faces.triangles[t][j], faces.triangles[t][i]}] = label->second;
        }
    }
}

void scale_lines(const RawMesh& raw, SurfaceMesh& surface) {
    for (const RawMesh::Line& line : raw.lines) {
        ModelLine scaled{line.names, {}};
        for (const Index v : line.vertices)
            scaled.points.push_back(surface.unit_mm * raw.positions[static_cast<std::size_t>(v)]);
        surface.lines.push_back(std::move(scaled));
    }
}

/// Borders first: what is joined along a part of a border only is then joined along all of it.
void mend(const RawMesh& raw, const WeldOptions& options, HoleRule holes, Faces& faces,
          std::vector<Repair>& repairs) {
    drop_repeated_faces(faces, repairs);
    wind_alike(faces, repairs);
    const std::optional<Error> parted = edge_to_part(faces);
    std::vector<Triangle> sound;
    make_manifold(faces, repairs, sound);
    drop_strays(faces, repairs);
    clean_faces(faces, repairs);
    if (faces.triangles.empty())
        throw Error(ErrorCode::mesh_degenerate, "no face is left to flatten");
    make_manifold(faces, repairs, sound);
    close_borders(options, holes, !joins_coincident(raw, options), faces, repairs);
    close_t_junctions(faces, tolerance::same_position * size_of(faces), repairs);
    clean_faces(faces, repairs);
    make_manifold(faces, repairs, sound);
    if (holes == HoleRule::automatic) close_small_holes(faces, repairs);
    if (parted && !is_closed(faces.sides())) throw *parted;
    if (options.groups.empty()) drop_inner_shells(faces, repairs);
    turn_outward(faces, repairs);
}

}  // namespace

SurfaceMesh weld(const RawMesh& raw, const WeldOptions& options, HoleRule holes,
                 const LoadLimits& limits) {
    SurfaceMesh result;
    result.warnings = raw.warnings;
    const UnitGuess unit = unit_of(raw, options);
    result.unit_mm = unit.unit_mm;
    if (unit.warning) result.warnings.push_back(*unit.warning);
    Faces faces;
    faces.positions.resize(raw.positions.size());
    std::transform(raw.positions.begin(), raw.positions.end(), faces.positions.begin(),
                   [&](const Vec3& p) -> Vec3 { return unit.unit_mm * p; });
    check_coordinates(faces.positions);
    (void)selected_labels(raw, options.groups);  // a wrong name is said before anything else
    faces.triangles = raw.triangles;
    for (std::size_t t = 0; t < raw.triangles.size(); ++t)
        faces.origins.push_back({raw.triangle_labels[t], static_cast<Index>(t)});
    merge_coincident(raw, options, faces, result.repairs);
    check_size(raw, faces, limits);
    mend(raw, options, holes, faces, result.repairs);
    warn_of_gaps(options, faces, result.warnings);
    select_faces(raw, options, faces, result);
    if (!options.groups.empty()) split_chosen(faces, result);
    list_split_vertices(faces, result.repairs);
    if (faces.triangles.empty())
        throw Error(ErrorCode::mesh_degenerate, "no face of these groups is left to flatten");
    check_shapes(faces);
    check_manifold(faces.positions, faces.triangles, faces.sides());
    result.mesh = build_mesh(faces.positions, faces.triangles);
    result.origins = std::move(faces.origins);
    result.file_triangles = raw.triangles.size();
    scale_lines(raw, result);
    result.welded_to = std::move(faces.welded_to);
    result.copies = std::move(faces.copies);
    return result;
}

}  // namespace lastflat
