// An elimination order of little fill for graphs that lie in the plane.
#pragma once

#include <vector>

#include "core/numerics/types.h"

namespace lastflat {

/// Neighbours of vertex v: neighbours[begin[v]] .. neighbours[begin[v + 1] - 1].
struct VertexGraph {
    std::vector<Index> begin, neighbours;
    [[nodiscard]] Index size() const { return static_cast<Index>(begin.size()) - 1; }
};

/// The graph of these pairs, in both directions; a pair may be given more than once. Neighbours
/// ascend.
[[nodiscard]] VertexGraph vertex_graph(Index vertices,
                                       const std::vector<std::pair<Index, Index>>& pairs);

/// Vertices that are eliminated together. Blocks of different branches share no edge.
struct EliminationBlock {
    Index parent;  ///< -1: a root
    std::vector<Index> vertices;
};

/// Splits the graph again and again by a line across its longest direction; the vertices on the
/// line come after those on its sides.
///
/// Where every line meets too much, it is split by the distance along the edges instead.
///
/// Paper: [george-1973]; any lines instead of the grid's: [heath-1995]; distances: [george-1978].
/// In:    per vertex its position: neighbours should be near each other.
/// Out:   every vertex in one block; blocks come after their children.
[[nodiscard]] std::vector<EliminationBlock> nested_dissection(const VertexGraph& graph,
                                                              const Points2& positions);

}  // namespace lastflat
