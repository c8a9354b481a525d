// A surface's half-edges, each with its triangle laid into the plane: what unfolding needs.
#pragma once

#include "core/numerics/types.h"

namespace lastflat {

/// Half-edge 3 t + i runs from corner i of triangle t to the next corner and bounds t. Its frame
/// has the edge along +x from the origin and the triangle above it.
class HalfEdges {
public:
    explicit HalfEdges(const Triangulation& surface);

    [[nodiscard]] static Index next(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }
    [[nodiscard]] static Index previous(Index h) { return h % 3 == 0 ? h + 2 : h - 1; }

    [[nodiscard]] Index from(Index h) const { return edge(h).from; }
    [[nodiscard]] Index to(Index h) const { return edge(next(h)).from; }
    [[nodiscard]] Index apex(Index h) const { return edge(previous(h)).from; }
    /// The same edge in the neighbouring triangle; -1 on the border.
    [[nodiscard]] Index twin(Index h) const { return edge(h).twin; }
    [[nodiscard]] double length(Index h) const { return edge(h).length; }
    /// Place of the triangle's third corner in the half-edge's frame.
    [[nodiscard]] const Vec2& apex_place(Index h) const { return edge(h).apex; }
    /// The triangle's angle where the half-edge begins.
    [[nodiscard]] double angle(Index h) const;

    /// A half-edge from the vertex; on the border the one that runs along the border. -1: isolated.
    [[nodiscard]] Index outgoing(Index vertex) const {
        return outgoing_[static_cast<std::size_t>(vertex)];
    }
    /// The next half-edge from the same vertex, counter-clockwise; -1 past the last of the border.
    [[nodiscard]] Index rotated(Index h) const { return twin(previous(h)); }
    [[nodiscard]] bool on_border(Index vertex) const { return twin(outgoing(vertex)) < 0; }
    /// Sum of the angles around the vertex.
    [[nodiscard]] double total_angle(Index vertex) const;

    [[nodiscard]] Index count() const { return static_cast<Index>(edges_.size()); }
    [[nodiscard]] Index vertex_count() const { return static_cast<Index>(outgoing_.size()); }

private:
    struct Edge {
        Vec2 apex;
        double length;
        Index from, twin;
    };
    [[nodiscard]] const Edge& edge(Index h) const { return edges_[static_cast<std::size_t>(h)]; }

    std::vector<Edge> edges_;
    std::vector<Index> outgoing_;
};

}  // namespace lastflat
