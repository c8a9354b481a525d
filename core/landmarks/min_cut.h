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
/// Paper:     [dinic-1970]; a minimum cut is a maximum flow from one side to the other. Beyond
///            20,000 free nodes first on a graph in which pairs with dear edges are one, and so on;
///            then near to that cut [lombaert-2005].
/// Guarantee: the sum of the weights between the two sides is the least there is, of a larger graph
///            the least near to the coarse cut, round-off apart.
[[nodiscard]] std::vector<bool> minimum_cut(const std::vector<GraphEdge>& edges,
                                            const std::vector<Side2>& nodes);

}  // namespace lastflat
