// Constraints by name, and what a lock binds.
#pragma once

#include <string_view>

#include "core/cut/region.h"
#include "core/request.h"

namespace lastflat {

/// The word for its kind: "lock", "total_area".
[[nodiscard]] std::string_view name(const Constraint& constraint);

/// "lock of heel", "range of topline", "total area of lateral": for people.
[[nodiscard]] std::string title(const Constraint& constraint);

/// Whether a constraint that names `wanted` (nothing: every region) binds this one.
[[nodiscard]] bool binds(const std::string& wanted, const Region& region);

/// The runs of the region whose every edge is locked.
[[nodiscard]] std::vector<const CurveRun*> runs_locked_by_edges(
    const Region& region, const std::vector<Constraint>& constraints);

/// Per border edge, whether a lock of kind `edges` holds it.
[[nodiscard]] std::vector<bool> locked_border_edges(const Region& region,
                                                    const std::vector<Constraint>& constraints);

}  // namespace lastflat
