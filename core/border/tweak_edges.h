// A closed polygon of given angles whose edges change as little as possible.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/numerics/types.h"

namespace lastflat {

/// Closes a polygon by changing the lengths of its free edges.
///
/// Paper:  [sederberg-1993] by way of [kim-kim], section 3.3, with the closure taken over all edges
///         (the paper's sums skip the locked ones, and its polygon would not close): the s_i that
///         minimise sum s_i^2 / l_i^2 over the free edges subject to sum (l_i + s_i) d_i = 0.
/// In:     per edge its length, mm, and whether it is locked; per vertex its turning, of sum 2 pi.
///         Edge i runs from vertex i to the next. `name_edge` says where edge i is, for errors.
/// Out:    the vertices; vertex 0 at the origin, edge 0 along +x. Locked edges keep their length.
/// Throws: Error{method_failed} if the free edges are too few or all parallel, or if one of them
///         would have to shrink to nothing.
[[nodiscard]] Points2 tweak_edges(const std::vector<double>& lengths,
                                  const std::vector<double>& turning,
                                  const std::vector<bool>& locked,
                                  const std::function<std::string(std::size_t)>& name_edge);

}  // namespace lastflat
