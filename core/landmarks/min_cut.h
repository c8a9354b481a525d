// The cheapest way to part a graph in two.
#pragma once

#include <vector>

#include "core/numerics/types.h"

namespace lastflat {

struct GraphEdge {
    Index a, b;
    double weight;  ///< what it costs to part them
};

enum class Side2 : signed char { first, second, free };

/// For every node, whether it falls to the first side. Nodes of a side that is given stay there.
///
/// Paper:     [dinic-1970]; a minimum cut is a maximum flow from one side to the other.
/// Guarantee: the sum of the weights between the two sides is the least there is, round-off apart.
[[nodiscard]] std::vector<bool> minimum_cut(const std::vector<GraphEdge>& edges,
                                            const std::vector<Side2>& nodes);

}  // namespace lastflat
