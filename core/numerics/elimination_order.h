// The order in which the unknowns of a sparse system are eliminated.
#pragma once

#include "core/numerics/half_edges.h"

namespace lastflat {

/// Unknowns, the first to be eliminated first.
using EliminationOrder = std::vector<Index>;

/// An order of little fill for any matrix of this pattern (approximate minimum degree).
/// In: a square matrix whose pattern is symmetric, both triangles; only its pattern matters.
[[nodiscard]] EliminationOrder elimination_order(const SparseMatrix& pattern);

/// The same for systems that tie every vertex of a surface to its neighbours.
[[nodiscard]] EliminationOrder elimination_order(const HalfEdges& half_edges);

}  // namespace lastflat
