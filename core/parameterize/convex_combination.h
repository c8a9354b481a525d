// The convex combination family: one linear system for every choice of weights.
#pragma once

#include "core/cut/one_rings.h"
#include "core/numerics/types.h"

namespace lastflat {

struct WeightedNeighbour {
    Index vertex;
    double weight;
};

/// Per vertex its neighbours and their weights; empty: the vertex is fixed.
using WeightRows = std::vector<std::vector<WeightedNeighbour>>;

/// Places every vertex with a row at the weighted mean of its neighbours.
///
/// Paper:  [floater-1997], section 3. If all weights are positive and the fixed vertices form a
///         strictly convex polygon around a triangulated disk, no triangle flips.
/// In:     rows; `fixed`: a place for every vertex, read where the row is empty.
/// Out:    a place for every vertex; fixed ones as given.
/// Throws: Error{solver_failed} if the system is singular.
[[nodiscard]] Points2 solve_convex_combinations(const WeightRows& rows, const Points2& fixed);

/// A star of directions around a vertex: its neighbours with their distances, and the angle between
/// each neighbour and the next.
struct Star {
    std::vector<Index> neighbours;
    std::vector<double> distances;
    std::vector<double> angles;  ///< as many as neighbours: the star is closed
};

/// w_j = (tan(a_{j-1} / 2) + tan(a_j / 2)) / r_j. Positive while all angles are below pi.
///
/// Paper: [floater-2003], formula 2.1 (theorem 1).
[[nodiscard]] std::vector<WeightedNeighbour> mean_value_weights(const Star& star);

/// The star of an inner vertex as it is on the surface: 3D distances, 3D angles.
[[nodiscard]] Star surface_star(const Region& region, const OneRings& rings, Index vertex);

}  // namespace lastflat
