#include "core/geodesic/unfolding.h"

#include <Eigen/Geometry>
#include <cmath>

namespace lastflat {

double HalfEdgeFrame::angle() const {
    return std::atan2(apex.y(), apex.x());
}

HalfEdgeFrame frame_of(const Triangulation& surface, Index half_edge) {
    const Triangle& t = surface.triangles[at(half_edge / 3)];
    const std::size_t i = at(half_edge % 3);
    const Vec3& origin = surface.position(t[i]);
    const Vec3 along = surface.position(t[(i + 1) % 3]) - origin;
    const Vec3 across = surface.position(t[(i + 2) % 3]) - origin;
    const double length = along.norm();
    return {{along.dot(across) / length, along.cross(across).norm() / length}, length};
}

Unfolding::Unfolding(const Triangulation& surface, HalfEdges half_edges)
    : HalfEdges(std::move(half_edges)) {
    frames_.reserve(at(count()));
    for (Index h = 0; h < count(); ++h) frames_.push_back(frame_of(surface, h));
}

}  // namespace lastflat
