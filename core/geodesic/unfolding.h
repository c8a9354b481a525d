// Triangles laid into the plane, each along every one of its half-edges.
#pragma once

#include "core/numerics/half_edges.h"

namespace lastflat {

/// A half-edge along +x from the origin, its triangle above it.
struct HalfEdgeFrame {
    Vec2 apex;  ///< the triangle's third corner
    double length;

    /// The triangle's angle where the half-edge begins.
    [[nodiscard]] double angle() const;
};

[[nodiscard]] HalfEdgeFrame frame_of(const Triangulation& surface, Index half_edge);

class Unfolding : public HalfEdges {
public:
    /// The surface's own half-edges.
    Unfolding(const Triangulation& surface, HalfEdges half_edges);

    [[nodiscard]] double length(Index h) const { return frames_[at(h)].length; }
    /// The third corner in the half-edge's frame.
    [[nodiscard]] const Vec2& apex_position(Index h) const { return frames_[at(h)].apex; }
    [[nodiscard]] double angle(Index h) const { return frames_[at(h)].angle(); }

private:
    std::vector<HalfEdgeFrame> frames_;
};

}  // namespace lastflat
