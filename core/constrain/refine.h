// From the start of a method to its answer.
#pragma once

#include "core/constrain/resolve_conflicts.h"

namespace lastflat {

/// The starts of a domain as they become the answer of the request's method: at the least of its
/// energy (`isometric` under the constraints), or each scaled as a whole to its locks.
///
/// `left`: if not null, takes what stays warm of `isometric`.
/// Throws: Error, as `least_distortion`.
[[nodiscard]] ConstrainedChart refine(const Domain& domain, std::vector<Chart> starts,
                                      const Request& request,
                                      const std::vector<Constraint>& constraints,
                                      std::size_t threads, const Progress& progress,
                                      Warmth* left = nullptr);

/// `least_distortion_again` of `isometric`; nothing for any other method.
[[nodiscard]] std::optional<ConstrainedChart> refine_again(
    const Domain& domain, const Request& request, const std::vector<Constraint>& constraints,
    std::size_t threads, const Progress& progress, Warmth& warmth);

/// `refresh` for `isometric`.
void refresh(const Domain& domain, const Request& request,
             const std::vector<Constraint>& constraints, std::size_t threads,
             const Progress& progress, Warmth& warmth);

}  // namespace lastflat
