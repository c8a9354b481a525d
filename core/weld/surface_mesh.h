// The surface that takes part: manifold, oriented, in mm.
#pragma once

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/numerics/types.h"
#include "core/weld/face_origin.h"
#include "core/weld/repair.h"

namespace lastflat {

struct SurfaceTraits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
};
using TriMesh = OpenMesh::TriMesh_ArrayKernelT<SurfaceTraits>;

/// A line of the model, such as a drawn curve.
struct ModelLine {
    std::vector<std::string> names;
    Points3 points;  ///< mm
};

/// The mesh of these vertices and faces. Throws: Error{mesh_not_manifold}.
[[nodiscard]] TriMesh build_mesh(const Points3& positions, const std::vector<Triangle>& triangles);

/// Where a feature of the last was taken off and the surface filled.
struct FilledFeature {
    Vec3 centre;
    double across_mm;
    Index first_face, faces;  ///< the filling, of the mesh

    [[nodiscard]] bool holds(Index face) const {
        return face >= first_face && face < first_face + faces;
    }
};

/// Vertex handles are the ids of the file, and copies of vertices where the surface touched itself;
/// a vertex that was welded away, or that no selected face uses, is isolated.
struct SurfaceMesh {
    TriMesh mesh;
    std::vector<Index> welded_to;  ///< per id, the id that stands for it
    std::vector<Index> copies;     ///< of the last ids: of which vertex of the file
    std::vector<Warning> warnings;
    std::vector<Repair> repairs;
    double unit_mm = 1.0;                              ///< one unit of the model
    std::size_t file_triangles = 0;                    ///< of the model
    std::vector<std::vector<std::string>> label_sets;  ///< as in `RawMesh`
    std::vector<FaceOrigin> origins;                   ///< per face of the mesh
    /// Labels of faces that take no part, beside the border: by the border's half-edge, from, to.
    std::map<std::pair<Index, Index>, std::uint32_t> labels_beyond;
    std::vector<ModelLine> lines;
    std::vector<FilledFeature> filled;

    /// The label of the face to the left of a half-edge, whether it takes part or not.
    [[nodiscard]] std::optional<std::uint32_t> label_at(OpenMesh::HalfedgeHandle h) const {
        if (!mesh.is_boundary(h))
            return origins[static_cast<std::size_t>(mesh.face_handle(h).idx())].label;
        const auto beyond =
            labels_beyond.find({mesh.from_vertex_handle(h).idx(), mesh.to_vertex_handle(h).idx()});
        if (beyond == labels_beyond.end()) return std::nullopt;
        return beyond->second;
    }

    [[nodiscard]] Vec3 position(Index vertex) const {
        const auto& p = mesh.point(OpenMesh::VertexHandle(vertex));
        return {p[0], p[1], p[2]};
    }
    /// Whether the id exists and a selected face uses it.
    [[nodiscard]] bool is_on_surface(Index vertex) const {
        return vertex >= 0 && vertex < static_cast<Index>(welded_to.size()) &&
               !mesh.is_isolated(
                   OpenMesh::VertexHandle(welded_to[static_cast<std::size_t>(vertex)]));
    }
};

/// Whether it has a border.
[[nodiscard]] bool is_open(const SurfaceMesh& surface);

}  // namespace lastflat
