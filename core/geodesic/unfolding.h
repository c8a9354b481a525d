// Triangles laid into the plane, each along every one of its half-edges.
#pragma once

#include "core/numerics/geometry.h"
#include "core/numerics/half_edges.h"

namespace lastflat {

/// A half-edge's triangle in its frame: the half-edge along +x from the origin.
[[nodiscard]] FlatTriangle frame_of(const Triangulation& surface, Index half_edge);

class Unfolding : public HalfEdges {
public:
    /// The surface's own half-edges.
    Unfolding(const Triangulation& surface, HalfEdges half_edges);

    [[nodiscard]] double length(Index h) const { return frames_[at(h)].length; }
    /// The third corner in the half-edge's frame.
    [[nodiscard]] const Vec2& apex_position(Index h) const { return frames_[at(h)].apex; }
    /// Of the triangle, where the half-edge begins.
    [[nodiscard]] double angle(Index h) const { return frames_[at(h)].angle(); }

private:
    std::vector<FlatTriangle> frames_;
};

}  // namespace lastflat
