#include "core/weld/surface_mesh.h"

#include <algorithm>

#include "core/text.h"

namespace lastflat {

TriMesh build_mesh(const Points3& positions, const std::vector<Triangle>& triangles) {
    TriMesh mesh;
    mesh.reserve(positions.size(), triangles.size() * 3 / 2 + 64, triangles.size());
    for (const Vec3& p : positions) mesh.add_vertex({p.x(), p.y(), p.z()});
    for (const Triangle& t : triangles) {
        const auto face = mesh.add_face(OpenMesh::VertexHandle(t[0]), OpenMesh::VertexHandle(t[1]),
                                        OpenMesh::VertexHandle(t[2]));
        if (!face.is_valid()) {
            const Vec3& p = positions[static_cast<std::size_t>(t[0])];
            throw Error(ErrorCode::mesh_not_manifold,
                        "the faces around " + position_text(p) + " do not form a surface")
                .at_position(p);
        }
    }
    return mesh;
}

bool is_open(const SurfaceMesh& surface) {
    return std::any_of(surface.mesh.edges_begin(), surface.mesh.edges_end(),
                       [&](auto edge) { return surface.mesh.is_boundary(edge); });
}

}  // namespace lastflat
