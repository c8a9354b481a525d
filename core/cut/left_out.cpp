#include "core/cut/left_out.h"

#include <algorithm>
#include <cmath>

#include "core/numerics/geometry.h"
#include "core/text.h"

namespace lastflat {
namespace {

constexpr std::size_t most_told = 10;

enum class EdgeKind : std::uint8_t { inner, brim, cut };  ///< brim: featherline or topline

struct LeftOut {
    double area = 0.0;
    Vec3 position = Vec3::Zero();  ///< of the face nearest to its middle
    bool at_brim = false, at_cut = false;
};

Triangle sorted_corners(const SurfaceMesh& surface, OpenMesh::FaceHandle face) {
    Triangle triangle = corners_of(surface, face.idx());
    std::sort(triangle.begin(), triangle.end());
    return triangle;
}

Vec3 centre_of(const SurfaceMesh& surface, OpenMesh::FaceHandle face) {
    return centroid(surface, corners_of(surface, face.idx()));
}

std::vector<EdgeKind> edge_kinds(const TriMesh& mesh, const Curves& curves,
                                 const std::vector<std::string>& cuts) {
    std::vector<EdgeKind> kinds(mesh.n_edges(), EdgeKind::inner);
    for (const Curve& curve : curves) {
        if (!contains(cuts, curve.name)) continue;
        const bool is_brim =
            curve.name == curve_name::featherline || curve.name == curve_name::topline;
        for (std::size_t i = 1; i < curve.vertices.size(); ++i) {
            const auto side = mesh.find_halfedge(OpenMesh::VertexHandle(curve.vertices[i - 1]),
                                                 OpenMesh::VertexHandle(curve.vertices[i]));
            EdgeKind& kind = kinds[at(mesh.edge_handle(side).idx())];
            kind = std::max(kind, is_brim ? EdgeKind::brim : EdgeKind::cut);
        }
    }
    return kinds;
}

/// Per face, whether it is in a region.
std::vector<bool> taken_faces(const SurfaceMesh& surface, const std::vector<Region>& regions) {
    std::vector<Triangle> taken;
    for (const Region& region : regions) {
        for (Triangle t : region.triangles) {
            for (Index& v : t) v = region.source_vertices[at(v)];
            std::sort(t.begin(), t.end());
            taken.push_back(t);
        }
    }
    std::sort(taken.begin(), taken.end());
    std::vector<bool> is_taken(surface.mesh.n_faces());
    for (const auto face : surface.mesh.faces())
        is_taken[at(face.idx())] =
            std::binary_search(taken.begin(), taken.end(), sorted_corners(surface, face));
    return is_taken;
}

/// The piece around a face; all of its faces are seen then.
LeftOut piece_around(const SurfaceMesh& surface, OpenMesh::FaceHandle seed,
                     const std::vector<EdgeKind>& kinds, std::vector<bool>& seen) {
    const TriMesh& mesh = surface.mesh;
    LeftOut piece;
    std::vector<OpenMesh::FaceHandle> faces{seed};
    seen[at(seed.idx())] = true;
    Vec3 middle = Vec3::Zero();
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const auto face = faces[i];
        piece.area += mesh.calc_face_area(face);
        middle += mesh.calc_face_area(face) * centre_of(surface, face);
        for (const auto side : mesh.fh_range(face)) {
            const EdgeKind kind = kinds[at(mesh.edge_handle(side).idx())];
            piece.at_brim = piece.at_brim || kind == EdgeKind::brim;
            piece.at_cut = piece.at_cut || kind == EdgeKind::cut;
            const auto beyond = mesh.opposite_face_handle(side);
            if (kind != EdgeKind::inner || !beyond.is_valid() || seen[at(beyond.idx())]) continue;
            seen[at(beyond.idx())] = true;
            faces.push_back(beyond);
        }
    }
    middle /= piece.area;
    double nearest = HUGE_VAL;
    for (const auto face : faces) {
        const Vec3 centre = centre_of(surface, face);
        if ((centre - middle).norm() >= nearest) continue;
        nearest = (centre - middle).norm();
        piece.position = centre;
    }
    return piece;
}

}  // namespace

std::vector<Warning> left_out_pieces(const SurfaceMesh& surface, const Curves& curves,
                                     const std::vector<std::string>& cuts,
                                     const std::vector<Region>& regions) {
    std::size_t triangles = 0;
    for (const Region& region : regions) triangles += region.triangles.size();
    if (triangles == surface.mesh.n_faces()) return {};
    const auto kinds = edge_kinds(surface.mesh, curves, cuts);
    std::vector<bool> seen = taken_faces(surface, regions);
    std::vector<LeftOut> pieces;
    for (const auto face : surface.mesh.faces()) {
        if (seen[at(face.idx())]) continue;
        const LeftOut piece = piece_around(surface, face, kinds, seen);
        if (piece.at_cut || !piece.at_brim) pieces.push_back(piece);
    }
    std::stable_sort(pieces.begin(), pieces.end(),
                     [](const LeftOut& a, const LeftOut& b) { return a.area > b.area; });
    if (pieces.size() > most_told) pieces.resize(most_told);
    std::vector<Warning> warnings;
    warnings.reserve(pieces.size());
    for (const LeftOut& piece : pieces) {
        warnings.push_back({"piece_left_out",
                            "a piece of " + fixed_text(piece.area / 100.0, 1) + " cm2 by " +
                                position_text(piece.position) +
                                " is none of the regions and is left out",
                            piece.position});
    }
    return warnings;
}

}  // namespace lastflat
