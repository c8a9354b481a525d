// An elimination order of little fill for graphs that lie in space.
#pragma once

#include <vector>

#include "core/numerics/types.h"

namespace lastflat {

/// Neighbours of vertex v: neighbours[begin[v]] .. neighbours[begin[v + 1] - 1].
struct VertexGraph {
    std::vector<Index> begin, neighbours;
    [[nodiscard]] Index size() const { return static_cast<Index>(begin.size()) - 1; }
};

/// The graph of these pairs, each counted once, in both directions.
[[nodiscard]] VertexGraph vertex_graph(Index vertices, std::vector<std::pair<Index, Index>> pairs);

/// Vertices that are eliminated together. Blocks of different branches share no edge.
struct EliminationBlock {
    Index parent;  ///< -1: a root
    std::vector<Index> vertices;
};

/// Splits the graph again and again by a plane across its longest direction; the vertices on the
/// plane come after those on its sides.
///
/// Paper: [george-1973]; the planes instead of grid lines: [heath-1995].
/// In:    per vertex its place: neighbours should be near each other.
/// Out:   every vertex in one block; blocks come after their children.
[[nodiscard]] std::vector<EliminationBlock> nested_dissection(const VertexGraph& graph,
                                                              const Points3& positions);

}  // namespace lastflat
