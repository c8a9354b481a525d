#include "core/cut/cut.h"

#include <algorithm>
#include <cmath>

#include "core/cut/curve_runs.h"
#include "core/cut/find_border.h"
#include "core/numerics/disjoint_sets.h"

namespace lastflat {
namespace {

using Mesh = TriMesh;

/// More pieces than this are no pattern but a broken model (vertices that are not shared).
constexpr Index max_default_regions = 64;

/// A point that is meant to be in a region is near it.
constexpr double max_choice_distance_mm = 50.0;

/// Marks the edges of the named curves, which stand in this list of the request.
void open_edges(const SurfaceMesh& surface, const Curves& curves,
                const std::vector<std::string>& names, const std::string& list,
                std::vector<bool>& open) {
    for (std::size_t i = 0; i < names.size(); ++i) {
        const auto curve = std::find_if(curves.begin(), curves.end(),
                                        [&](const Curve& c) { return c.name == names[i]; });
        if (curve == curves.end()) {
            throw Error(ErrorCode::curve_invalid,
                        (list == "cuts" ? "cut '" : "seam '") + names[i] + "' names no curve")
                .at_option({list, std::to_string(i)});
        }
        for (std::size_t k = 1; k < curve->vertices.size(); ++k) {
            const auto halfedge =
                surface.mesh.find_halfedge(OpenMesh::VertexHandle(curve->vertices[k - 1]),
                                           OpenMesh::VertexHandle(curve->vertices[k]));
            open[static_cast<std::size_t>(surface.mesh.edge_handle(halfedge).idx())] = true;
        }
    }
}

/// Per edge of the mesh, whether the surface is opened there.
std::vector<bool> opened_edges(const SurfaceMesh& surface, const Curves& curves,
                               const CutOptions& options) {
    std::vector<bool> open(surface.mesh.n_edges(), false);
    open_edges(surface, curves, options.cuts, "cuts", open);
    open_edges(surface, curves, options.seams, "seams", open);
    return open;
}

/// Corner ids: three per face, in the order of the face's halfedges' target vertices.
struct Pieces {
    std::vector<Index> piece_of_face;
    std::vector<std::vector<std::size_t>> faces_of_piece;  ///< ascending
    std::vector<std::array<Index, 3>> face_vertices;       ///< mesh vertices
    std::vector<Index> corner_sets;                        ///< per corner, its fan
    Index count = 0;
};

Index corner_at(const Mesh& mesh, OpenMesh::FaceHandle face, OpenMesh::VertexHandle vertex) {
    Index corner = 0;
    for (const auto v : mesh.fv_range(face)) {
        if (v == vertex) break;
        ++corner;
    }
    return 3 * face.idx() + corner;
}

Pieces split(const Mesh& mesh, const std::vector<bool>& open) {
    Pieces pieces;
    const std::size_t faces = mesh.n_faces();
    DisjointSets face_sets(faces), fans(3 * faces);
    for (const auto edge : mesh.edges()) {
        if (mesh.is_boundary(edge) || open[static_cast<std::size_t>(edge.idx())]) continue;
        const auto h = mesh.halfedge_handle(edge, 0);
        const auto a = mesh.face_handle(h), b = mesh.face_handle(mesh.opposite_halfedge_handle(h));
        face_sets.join(a.idx(), b.idx());
        for (const auto v : {mesh.from_vertex_handle(h), mesh.to_vertex_handle(h)}) {
            fans.join(corner_at(mesh, a, v), corner_at(mesh, b, v));
        }
    }
    pieces.face_vertices.resize(faces);
    pieces.piece_of_face.resize(faces);
    pieces.corner_sets.resize(3 * faces);
    std::vector<Index> piece_of_set(faces, -1);
    for (const auto face : mesh.faces()) {
        const auto f = static_cast<std::size_t>(face.idx());
        const auto set = static_cast<std::size_t>(face_sets.find(face.idx()));
        if (piece_of_set[set] < 0) {
            piece_of_set[set] = pieces.count++;
            pieces.faces_of_piece.emplace_back();
        }
        pieces.piece_of_face[f] = piece_of_set[set];
        pieces.faces_of_piece[static_cast<std::size_t>(piece_of_set[set])].push_back(f);
        std::size_t i = 0;
        for (const auto v : mesh.fv_range(face)) {
            pieces.face_vertices[f][i] = v.idx();
            pieces.corner_sets[3 * f + i] = fans.find(static_cast<Index>(3 * f + i));
            ++i;
        }
    }
    return pieces;
}

/// The pieces at a vertex, ascending, without repetition.
std::vector<Index> pieces_at(const SurfaceMesh& surface, const Pieces& pieces, Index vertex) {
    std::vector<Index> found;
    for (const auto face : surface.mesh.vf_range(OpenMesh::VertexHandle(vertex))) {
        found.push_back(pieces.piece_of_face[static_cast<std::size_t>(face.idx())]);
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

Index nearest_vertex(const SurfaceMesh& surface, const Vec3& position) {
    Index best = -1;
    double least = 0.0;
    for (const auto v : surface.mesh.vertices()) {
        if (surface.mesh.is_isolated(v)) continue;
        const double distance = (surface.position(v.idx()) - position).squaredNorm();
        if (best < 0 || distance < least) {
            best = v.idx();
            least = distance;
        }
    }
    return best;
}

[[noreturn]] void fail_choice(const RegionChoice& choice, const std::string& what) {
    throw Error(ErrorCode::region_invalid, "region '" + choice.name + "': " + what)
        .at_option({"regions", choice.name});
}

Index chosen_piece(const SurfaceMesh& surface, const Pieces& pieces, const RegionChoice& choice) {
    if (!choice.inside) {
        if (pieces.count == 1) return 0;
        fail_choice(choice, "the cuts leave " + std::to_string(pieces.count) +
                                " pieces; say which is meant by a point on it");
    }
    Index vertex = -1;
    if (const auto* position = std::get_if<Vec3>(&*choice.inside)) {
        vertex = nearest_vertex(surface, *position);
        const double distance = (surface.position(vertex) - *position).norm();
        if (distance > max_choice_distance_mm) {
            fail_choice(choice, "the position is " + std::to_string(std::lround(distance)) +
                                    " mm away from the surface; are the units right?");
        }
    } else {
        vertex = std::get<Index>(*choice.inside);
        if (!surface.is_on_surface(vertex))
            fail_choice(choice,
                        "vertex " + std::to_string(vertex) + " is not on the selected faces");
    }
    const auto found =
        pieces_at(surface, pieces, surface.welded_to[static_cast<std::size_t>(vertex)]);
    if (found.size() > 1) {
        fail_choice(choice, "vertex " + std::to_string(vertex) + " lies on a cut, between " +
                                std::to_string(found.size()) + " pieces; choose one inside");
    }
    return found.front();
}

Region extract(const SurfaceMesh& surface, const Pieces& pieces, Index piece) {
    struct Corner {
        Index source, fan;
        std::size_t slot;
    };
    std::vector<Corner> corners;
    Region region;
    for (const std::size_t f : pieces.faces_of_piece[static_cast<std::size_t>(piece)]) {
        for (std::size_t i = 0; i < 3; ++i) {
            corners.push_back({pieces.face_vertices[f][i], pieces.corner_sets[3 * f + i],
                               3 * region.triangles.size() + i});
        }
        region.triangles.emplace_back();
        region.source_triangles.push_back(surface.origins[f].triangle);
    }
    std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
        if (a.source != b.source) return a.source < b.source;
        return a.fan != b.fan ? a.fan < b.fan : a.slot < b.slot;
    });
    for (std::size_t i = 0; i < corners.size(); ++i) {
        if (i == 0 || corners[i].source != corners[i - 1].source ||
            corners[i].fan != corners[i - 1].fan) {
            region.source_vertices.push_back(corners[i].source);
            region.positions.push_back(surface.position(corners[i].source));
        }
        region.triangles[corners[i].slot / 3][corners[i].slot % 3] =
            static_cast<Index>(region.positions.size()) - 1;
    }
    return region;
}

}  // namespace

std::vector<Region> cut_into_regions(const SurfaceMesh& surface, const Curves& curves,
                                     const CutOptions& options) {
    const Pieces pieces = split(surface.mesh, opened_edges(surface, curves, options));
    std::vector<RegionChoice> choices = options.regions;
    std::vector<Index> chosen;
    for (const RegionChoice& choice : choices) {
        const Index piece = chosen_piece(surface, pieces, choice);
        if (const auto twin = std::find(chosen.begin(), chosen.end(), piece);
            twin != chosen.end()) {
            const auto other = static_cast<std::size_t>(twin - chosen.begin());
            fail_choice(choice, "is the same piece as region '" + choices[other].name +
                                    "'; no cut separates them");
        }
        chosen.push_back(piece);
    }
    if (choices.empty()) {
        if (pieces.count > max_default_regions) {
            throw Error(ErrorCode::region_invalid,
                        "the surface falls into " + std::to_string(pieces.count) + " pieces")
                .at_option({"regions"});
        }
        for (Index piece = 0; piece < pieces.count; ++piece) {
            chosen.push_back(piece);
            choices.push_back({"region_" + std::to_string(piece + 1)});
        }
    }
    std::vector<Region> regions;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        Region region = extract(surface, pieces, chosen[i]);
        region.name = choices[i].name;
        find_border(region);
        region.runs = curve_runs(region, curves);
        regions.push_back(std::move(region));
    }
    return regions;
}

}  // namespace lastflat
