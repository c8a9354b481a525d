// The neighbours of every vertex, in order around it.
#pragma once

#include <span>

#include "core/cut/region.h"
#include "core/numerics/elimination_order.h"

namespace lastflat {

/// Per vertex its neighbours, counter-clockwise seen from outside. Inside, the ring is closed: each
/// neighbour spans a triangle with the next, the last with the first. On the border it runs from
/// the border successor to the border predecessor.
class OneRings {
public:
    explicit OneRings(const Region& region);

    [[nodiscard]] std::span<const Index> of(Index vertex) const {
        const auto v = static_cast<std::size_t>(vertex);
        return {neighbours_.data() + begin_[v], begin_[v + 1] - begin_[v]};
    }
    /// Triangles around the vertex: as many as neighbours inside, one less on the border.
    [[nodiscard]] std::size_t triangle_count(Index vertex) const {
        return of(vertex).size() - (on_border(vertex) ? 1 : 0);
    }
    [[nodiscard]] Index vertex_count() const { return static_cast<Index>(on_border_.size()); }
    [[nodiscard]] bool on_border(Index vertex) const {
        return on_border_[static_cast<std::size_t>(vertex)];
    }

private:
    std::vector<std::size_t> begin_;
    std::vector<Index> neighbours_;
    std::vector<bool> on_border_;
};

/// An order of little fill for systems that tie every vertex of the region to its neighbours.
[[nodiscard]] EliminationOrder elimination_order(const OneRings& rings);

}  // namespace lastflat
