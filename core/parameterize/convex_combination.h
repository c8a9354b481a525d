// The convex combination family: one linear system for every choice of weights.
#pragma once

#include "core/numerics/surface_elimination.h"
#include "core/parameterize/weights.h"

namespace lastflat {

struct WeightedNeighbour {
    Index vertex;
    double weight;
};

/// Per vertex its neighbours and their weights; empty: the vertex is fixed.
using WeightRows = std::vector<std::vector<WeightedNeighbour>>;

/// Puts every vertex with a row at the weighted mean of its neighbours.
///
/// Paper:  [floater-1997], section 3. If all weights are positive and the fixed vertices form a
///         strictly convex polygon around a triangulated disk, no triangle flips.
/// In:     rows; `fixed`: a position for every vertex, read where the row is empty; the blocks in
///         which vertices are eliminated, of which those without a row are passed over.
/// Out:    a position for every vertex; fixed ones as given.
/// Throws: Error{solver_failed} if the system is singular.
[[nodiscard]] Points2 solve_convex_combinations(const WeightRows& rows, const Points2& fixed,
                                                const Dissection& dissection);

/// The row of a vertex with this star.
[[nodiscard]] std::vector<WeightedNeighbour> weighted_neighbours(const Star& star,
                                                                 WeightRule weights);

}  // namespace lastflat
