#include "core/locate/surface_point.h"

#include <algorithm>

namespace lastflat {

SurfacePoint between(const SurfacePoint& a, const SurfacePoint& b, double share) {
    std::vector<Index> vertices = a.support();
    for (const Index v : b.support()) {
        if (!contains(vertices, v)) vertices.push_back(v);
    }
    SurfacePoint point;
    point.corners.fill(vertices.front());
    for (std::size_t i = 0; i < std::min<std::size_t>(vertices.size(), 3); ++i) {
        point.corners[i] = vertices[i];
        point.weights[static_cast<Eigen::Index>(i)] =
            (1.0 - share) * a.weight_of(vertices[i]) + share * b.weight_of(vertices[i]);
    }
    return point;
}

Vec3 position_of(const SurfaceMesh& surface, const SurfacePoint& point) {
    Vec3 position = Vec3::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
        const double weight = point.weights[static_cast<Eigen::Index>(i)];
        if (weight != 0.0) position += weight * surface.position(point.corners[i]);
    }
    return position;
}

Triangle corners_of(const SurfaceMesh& surface, Index face) {
    Triangle corners{};
    std::size_t i = 0;
    for (const auto v : surface.mesh.fv_range(OpenMesh::FaceHandle(face))) corners[i++] = v.idx();
    return corners;
}

std::vector<Index> faces_at(const SurfaceMesh& surface, const SurfacePoint& point) {
    const std::vector<Index> support = point.support();
    std::vector<Index> faces;
    for (const auto face : surface.mesh.vf_range(OpenMesh::VertexHandle(support.front()))) {
        const Triangle corners = corners_of(surface, face.idx());
        const bool holds = std::all_of(support.begin(), support.end(),
                                       [&](Index v) { return contains(corners, v); });
        if (holds) faces.push_back(face.idx());
    }
    return faces;
}

bool share_a_face(const SurfaceMesh& surface, const SurfacePoint& a, const SurfacePoint& b) {
    const auto faces = faces_at(surface, a);
    for (const Index face : faces_at(surface, b)) {
        if (contains(faces, face)) return true;
    }
    return false;
}

}  // namespace lastflat
