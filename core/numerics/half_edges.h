// Which triangle lies beside which: the adjacency of a surface.
#pragma once

#include <iterator>

#include "core/numerics/types.h"

namespace lastflat {

/// Half-edge 3 t + i runs from corner i of triangle t to the next corner and bounds t.
///
/// In: a manifold: no edge has more than two triangles, which wind alike, and the triangles around
///     a vertex hang together. Isolated vertices are none's neighbour. Linear time.
class HalfEdges {
public:
    HalfEdges() = default;
    explicit HalfEdges(const Triangulation& surface);

    [[nodiscard]] static Index next(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }
    [[nodiscard]] static Index previous(Index h) { return h % 3 == 0 ? h + 2 : h - 1; }

    [[nodiscard]] Index from(Index h) const { return edge(h).from; }
    [[nodiscard]] Index to(Index h) const { return edge(next(h)).from; }
    [[nodiscard]] Index apex(Index h) const { return edge(previous(h)).from; }
    /// The same edge in the neighbouring triangle; -1 on the border.
    [[nodiscard]] Index twin(Index h) const { return edge(h).twin; }

    /// A half-edge from the vertex; on the border the one that runs along the border. -1: isolated.
    [[nodiscard]] Index outgoing(Index vertex) const { return outgoing_[at(vertex)]; }
    /// The next half-edge from the same vertex, counter-clockwise; -1 past the last of the border.
    [[nodiscard]] Index rotated(Index h) const { return twin(previous(h)); }
    [[nodiscard]] bool on_border(Index vertex) const {
        return outgoing(vertex) >= 0 && twin(outgoing(vertex)) < 0;
    }

    class Fan;
    /// All half-edges from the vertex, counter-clockwise, `outgoing` first.
    [[nodiscard]] Fan around(Index vertex) const;
    /// The vertex's neighbours, counter-clockwise: inside from the smallest on, each spans a
    /// triangle with the next, the last with the first; on the border from successor to
    /// predecessor.
    [[nodiscard]] std::vector<Index> ring(Index vertex) const;
    /// The half-edge between two vertices in this direction; -1: there is none.
    [[nodiscard]] Index find(Index from, Index to) const;
    /// The surface on their left; each from its smallest vertex, in the order of those.
    [[nodiscard]] std::vector<std::vector<Index>> border_loops() const;

    [[nodiscard]] Index count() const { return static_cast<Index>(edges_.size()); }
    [[nodiscard]] Index vertex_count() const { return static_cast<Index>(outgoing_.size()); }

private:
    struct Edge {
        Index from, twin;
    };
    [[nodiscard]] const Edge& edge(Index h) const { return edges_[at(h)]; }

    std::vector<Edge> edges_;
    std::vector<Index> outgoing_;
};

class HalfEdges::Fan {
public:
    class Iterator {
    public:
        Iterator(const HalfEdges& half_edges, Index first)
            : half_edges_(&half_edges), first_(first), at_(first) {}
        Index operator*() const { return at_; }
        Iterator& operator++() {
            at_ = half_edges_->rotated(at_);
            if (at_ == first_) at_ = -1;
            return *this;
        }
        friend bool operator==(const Iterator& i, std::default_sentinel_t) { return i.at_ < 0; }

    private:
        const HalfEdges* half_edges_;
        Index first_, at_;
    };
    explicit Fan(const Iterator& begin) : begin_(begin) {}
    [[nodiscard]] Iterator begin() const { return begin_; }
    [[nodiscard]] std::default_sentinel_t end() const { return {}; }

private:
    Iterator begin_;
};

inline HalfEdges::Fan HalfEdges::around(Index vertex) const {
    return Fan({*this, outgoing(vertex)});
}

}  // namespace lastflat
