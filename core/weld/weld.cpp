#include "core/weld/weld.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <set>

#include "core/numerics/tolerances.h"
#include "core/weld/check_manifold.h"
#include "core/weld/merge_vertices.h"

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

std::vector<Triangle> selected_triangles(const RawMesh& raw,
                                         const std::vector<std::string>& groups) {
    if (groups.empty()) return raw.triangles;
    std::vector<bool> wanted(raw.label_sets.size(), false);
    for (std::size_t g = 0; g < groups.size(); ++g) {
        bool found = false;
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            const auto& labels = raw.label_sets[i];
            if (std::find(labels.begin(), labels.end(), groups[g]) == labels.end()) continue;
            wanted[i] = found = true;
        }
        if (!found) {
            throw Error(ErrorCode::group_not_found,
                        "group '" + groups[g] + "' does not exist: " + known_groups(raw))
                .at_option({"surface", "groups", std::to_string(g)});
        }
    }
    std::vector<Triangle> result;
    for (std::size_t t = 0; t < raw.triangles.size(); ++t) {
        if (wanted[raw.triangle_labels[t]]) result.push_back(raw.triangles[t]);
    }
    return result;
}

void rename(std::vector<Triangle>& triangles, const std::vector<Index>& welded_to) {
    for (Triangle& triangle : triangles) {
        for (Index& vertex : triangle) vertex = welded_to[static_cast<std::size_t>(vertex)];
    }
}

/// A triangle that names a vertex twice covers nothing and joins nothing: it can go.
void drop_collapsed(std::vector<Triangle>& triangles, std::vector<Warning>& warnings) {
    const auto collapsed = [](const Triangle& t) {
        return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
    };
    const auto kept = std::remove_if(triangles.begin(), triangles.end(), collapsed);
    const auto dropped = triangles.end() - kept;
    if (dropped == 0) return;
    triangles.erase(kept, triangles.end());
    warnings.push_back(
        {"faces_dropped",
         std::to_string(dropped) + " triangles that name a vertex twice were left out",
         std::nullopt});
}

void check_shapes(const Points3& positions, const std::vector<Triangle>& triangles) {
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const auto at = [&](std::size_t i) {
            return positions[static_cast<std::size_t>(triangles[t][i])];
        };
        const double longest =
            std::max({(at(1) - at(0)).norm(), (at(2) - at(1)).norm(), (at(0) - at(2)).norm()});
        const double area = (at(1) - at(0)).cross(at(2) - at(0)).norm();
        // Negated, so that an overflow to NaN is caught as well.
        if (!(area > tolerance::degenerate_height * longest * longest) || !std::isfinite(area)) {
            throw Error(ErrorCode::mesh_degenerate, "triangle " + std::to_string(triangles[t][0]) +
                                                        " " + std::to_string(triangles[t][1]) +
                                                        " " + std::to_string(triangles[t][2]) +
                                                        " has no area, at " + place(at(0)) +
                                                        "; remove it or mend the mesh there")
                .at_position(at(0));
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

TriMesh build(const Points3& positions, const std::vector<Triangle>& triangles) {
    TriMesh mesh;
    mesh.reserve(positions.size(), triangles.size() * 3 / 2 + 64, triangles.size());
    for (const Vec3& p : positions) mesh.add_vertex({p.x(), p.y(), p.z()});
    for (const Triangle& t : triangles) {
        const auto face = mesh.add_face(OpenMesh::VertexHandle(t[0]), OpenMesh::VertexHandle(t[1]),
                                        OpenMesh::VertexHandle(t[2]));
        if (!face.is_valid()) {
            const Vec3& p = positions[static_cast<std::size_t>(t[0])];
            throw Error(ErrorCode::mesh_not_manifold,
                        "the faces around " + place(p) + " do not form a surface")
                .at_position(p);
        }
    }
    return mesh;
}

}  // namespace

SurfaceMesh weld(const RawMesh& raw, const WeldOptions& options) {
    SurfaceMesh result;
    const double unit = options.unit_mm.value_or(raw.default_unit_mm);
    Points3 positions(raw.positions.size());
    std::transform(raw.positions.begin(), raw.positions.end(), positions.begin(),
                   [unit](const Vec3& p) -> Vec3 { return unit * p; });

    auto triangles = selected_triangles(raw, options.groups);
    check_coordinates(positions);
    auto all = raw.triangles;
    if (options.tolerance_mm || !raw.indexed) {
        result.welded_to = merge_vertices(positions, options.tolerance_mm.value_or(0.0));
        rename(triangles, result.welded_to);
        rename(all, result.welded_to);
    } else {
        result.welded_to = each_for_itself(positions.size());
    }
    drop_collapsed(triangles, result.warnings);
    if (triangles.empty()) {
        throw Error(ErrorCode::mesh_degenerate, "no face is left to flatten");
    }
    check_shapes(positions, triangles);
    check_manifold(positions, triangles);
    if (is_closed(all) && signed_volume(positions, all) < 0.0) {
        for (Triangle& t : triangles) std::swap(t[1], t[2]);
        result.warnings.push_back({"orientation_reversed",
                                   "all faces of the closed model point inward; they were turned",
                                   std::nullopt});
    }
    result.mesh = build(positions, triangles);
    return result;
}

}  // namespace lastflat
