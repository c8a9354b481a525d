// In which blocks the vertices of a surface are eliminated.
#pragma once

#include <functional>

#include "core/numerics/front_tree.h"
#include "core/numerics/half_edges.h"
#include "core/numerics/nested_dissection.h"

namespace lastflat {

/// For systems that tie every vertex to its neighbours.
using Dissection = std::vector<EliminationBlock>;
[[nodiscard]] Dissection dissection_of(const Points3& positions, const HalfEdges& half_edges);

/// The unknowns of a system, in the order in which they are eliminated.
struct Elimination {
    std::vector<Index> vertices;       ///< per unknown
    std::vector<UnknownBlock> blocks;  ///< of unknowns, numbered one after the other
};
/// Of those vertices alone that are unknown.
[[nodiscard]] Elimination elimination_of(const Dissection& dissection,
                                         const std::function<bool(Index vertex)>& is_unknown);

}  // namespace lastflat
