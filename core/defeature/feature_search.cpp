#include "core/defeature/feature_search.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/defeature/hollow_walls.h"
#include "core/landmarks/min_cut.h"
#include "core/landmarks/smooth_normals.h"
#include "core/numerics/geometry.h"

namespace lastflat {
namespace {

/// Walls that reach further are no feature, but a part of the last.
constexpr double furthest_mm = 60.0;

/// A part of the surface as a graph of its own.
struct Part {
    std::vector<Index> faces;      ///< those that may belong to a feature
    std::map<Index, Index> nodes;  ///< per face, its node; the last node stands for all the rest
};

/// The faces that hang together with a patch of walls and come near to it.
Part part_around(const SurfaceMesh& surface, const std::vector<BareFace>& faces,
                 const std::vector<Index>& patch, double beyond_mm) {
    Part part;
    Vec3 centre = Vec3::Zero();
    for (const Index f : patch) centre += faces[at(f)].centre;
    centre /= static_cast<double>(patch.size());
    const auto distance = [&](Index f) {
        double least = (faces[at(f)].centre - centre).norm();
        for (const auto v : surface.mesh.fv_range(OpenMesh::FaceHandle(f)))
            least = std::min(least, (surface.position(v.idx()) - centre).norm());
        return least;
    };
    double reach = 0.0;
    for (const Index f : patch) reach = std::max(reach, (faces[at(f)].centre - centre).norm());
    if (reach > furthest_mm) return part;
    const double limit = reach + beyond_mm;
    part.faces = patch;
    for (const Index f : patch) part.nodes.emplace(f, static_cast<Index>(part.nodes.size()));
    for (std::size_t i = 0; i < part.faces.size(); ++i) {
        for (const auto next : surface.mesh.ff_range(OpenMesh::FaceHandle(part.faces[i]))) {
            if (part.nodes.contains(next.idx()) || distance(next.idx()) > limit) continue;
            part.nodes.emplace(next.idx(), static_cast<Index>(part.nodes.size()));
            part.faces.push_back(next.idx());
        }
    }
    return part;
}

/// Per node, whether it is on the walls' side of the least cut; islands in it, too.
std::vector<bool> parted(const SurfaceMesh& surface, const std::vector<BareFace>& faces,
                         const Part& part, std::size_t walls, double sharp) {
    const auto rest = static_cast<Index>(part.faces.size());
    std::vector<GraphEdge> edges;
    for (std::size_t i = 0; i < part.faces.size(); ++i) {
        for (const auto h : surface.mesh.fh_range(OpenMesh::FaceHandle(part.faces[i]))) {
            const Index other = surface.mesh.opposite_face_handle(h).idx();
            const auto found = part.nodes.find(other);
            const Index node = found == part.nodes.end() ? rest : found->second;
            if (node != rest && node < static_cast<Index>(i)) continue;
            const double bend =
                angle_between(faces[at(part.faces[i])].normal, faces[at(other)].normal);
            edges.push_back({static_cast<Index>(i), node,
                             parting_cost(bend, sharp, surface.mesh.calc_edge_length(h))});
        }
    }
    // Seen from the rest, so that of cuts that cost the same it is the outermost.
    std::vector<Side2> sides(part.faces.size() + 1, Side2::free);
    std::fill_n(sides.begin(), walls, Side2::second);
    sides.back() = Side2::first;
    std::vector<bool> inside = minimum_cut(edges, sides);
    inside.flip();
    std::vector<std::vector<Index>> beside(sides.size());
    for (const GraphEdge& edge : edges) {
        beside[at(edge.a)].push_back(edge.b);
        beside[at(edge.b)].push_back(edge.a);
    }
    std::vector<bool> outside(sides.size(), false);
    std::vector<Index> stack{rest};
    outside.back() = true;
    while (!stack.empty()) {
        const Index node = stack.back();
        stack.pop_back();
        for (const Index next : beside[at(node)]) {
            if (inside[at(next)] || outside[at(next)]) continue;
            outside[at(next)] = true;
            stack.push_back(next);
        }
    }
    outside.flip();
    return outside;
}

/// The loops between marked faces and the others; none if one touches itself.
std::vector<Rim> rims_of(const SurfaceMesh& surface, const std::vector<Index>& faces,
                         const std::vector<bool>& marked) {
    std::map<Index, Index> next;
    for (const Index f : faces) {
        for (const auto h : surface.mesh.fh_range(OpenMesh::FaceHandle(f))) {
            if (marked[at(surface.mesh.opposite_face_handle(h).idx())]) continue;
            if (!next.emplace(surface.mesh.from_vertex_handle(h).idx(),
                              surface.mesh.to_vertex_handle(h).idx())
                     .second)
                return {};
        }
    }
    std::vector<Rim> rims;
    while (!next.empty()) {
        Rim rim;
        for (auto step = next.begin(); step != next.end(); step = next.find(rim.back())) {
            if (rim.empty()) rim.push_back(step->first);
            rim.push_back(step->second);
            next.erase(step);
        }
        rim.pop_back();
        rims.push_back(std::move(rim));
    }
    return rims;
}

/// Takes in the faces at vertices where a rim would touch itself.
void close_pinches(const SurfaceMesh& surface, std::vector<Index>& faces,
                   std::vector<bool>& marked) {
    for (std::size_t i = 0; i < faces.size(); ++i) {
        for (const auto v : surface.mesh.fv_range(OpenMesh::FaceHandle(faces[i]))) {
            int changes = 0;
            for (const auto h : surface.mesh.voh_range(v))
                changes += marked[at(surface.mesh.face_handle(h).idx())] !=
                           marked[at(surface.mesh.opposite_face_handle(h).idx())];
            if (changes <= 2) continue;
            for (const auto face : surface.mesh.vf_range(v)) {
                if (marked[at(face.idx())]) continue;
                marked[at(face.idx())] = true;
                faces.push_back(face.idx());
            }
        }
    }
}

/// Pieces of a set of marked faces.
std::vector<std::vector<Index>> pieces_of(const SurfaceMesh& surface,
                                          const std::vector<Index>& faces,
                                          std::vector<bool> marked) {
    std::vector<std::vector<Index>> pieces;
    for (const Index seed : faces) {
        if (!marked[at(seed)]) continue;
        marked[at(seed)] = false;
        std::vector<Index> piece{seed};
        for (std::size_t i = 0; i < piece.size(); ++i) {
            for (const auto next : surface.mesh.ff_range(OpenMesh::FaceHandle(piece[i]))) {
                if (!marked[at(next.idx())]) continue;
                marked[at(next.idx())] = false;
                piece.push_back(next.idx());
            }
        }
        std::sort(piece.begin(), piece.end());
        pieces.push_back(std::move(piece));
    }
    return pieces;
}

}  // namespace

FeatureSearch::FeatureSearch(const SurfaceMesh& surface)
    : surface_(surface), faces_(bare_faces(surface)) {
    smooth_normals(surface, faces_);
    walls_ = hollow_walls(surface, faces_);
    if (!walls_.empty()) sharp_ = sharp_bend(surface, faces_);
}

std::vector<Feature> FeatureSearch::features_around(const std::vector<Index>& walls,
                                                    double beyond_mm) const {
    const Part part = part_around(surface_, faces_, walls, beyond_mm);
    if (part.faces.empty() || part.faces.size() == faces_.size()) return {};
    const auto inside = parted(surface_, faces_, part, walls.size(), sharp_);
    std::vector<Index> faces;
    std::vector<bool> marked(faces_.size(), false);
    for (std::size_t i = 0; i < part.faces.size(); ++i) {
        if (!inside[i]) continue;
        faces.push_back(part.faces[i]);
        marked[at(part.faces[i])] = true;
    }
    close_pinches(surface_, faces, marked);
    std::vector<Feature> features;
    for (auto& piece : pieces_of(surface_, faces, marked)) {
        auto rims = rims_of(surface_, piece, marked);
        if (rims.empty()) return {};
        features.push_back({std::move(piece), std::move(rims)});
    }
    return features;
}

}  // namespace lastflat
