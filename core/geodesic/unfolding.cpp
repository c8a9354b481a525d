#include "core/geodesic/unfolding.h"

namespace lastflat {

FlatTriangle frame_of(const Triangulation& surface, Index half_edge) {
    const Triangle& t = surface.triangles[at(half_edge / 3)];
    const std::size_t i = at(half_edge % 3);
    return laid_flat(surface.position(t[i]), surface.position(t[(i + 1) % 3]),
                     surface.position(t[(i + 2) % 3]));
}

Unfolding::Unfolding(const Triangulation& surface, HalfEdges half_edges)
    : HalfEdges(std::move(half_edges)) {
    frames_.reserve(at(count()));
    for (Index h = 0; h < count(); ++h) frames_.push_back(frame_of(surface, h));
}

}  // namespace lastflat
