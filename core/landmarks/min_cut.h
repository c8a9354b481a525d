// The cheapest way to part a graph in two.
#pragma once

#include <cmath>
#include <vector>

#include "core/numerics/types.h"

namespace lastflat {

struct GraphEdge {
    Index a, b;
    double weight;  ///< what it costs to part them
};

enum class Side2 : signed char { first, second, free };

/// What it costs to part two faces along an edge of this length: little where it bends sharply.
[[nodiscard]] inline double parting_cost(double bend, double sharp, double length) {
    constexpr double floor = 0.01;  // of the cost of a smooth edge
    return length * (floor + std::exp(-bend * bend / (sharp * sharp)));
}

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
