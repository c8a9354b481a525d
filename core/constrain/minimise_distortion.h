// From starts to the least distortion under rows.
#pragma once

#include "core/optimize/newton.h"

namespace lastflat {

/// Minimises the distortion of charts. Each start is scaled to its surface's area. Where they are
/// far from an isometry, rows are left alone at first; then the charts are turned and moved to
/// their pins: a rigid motion costs nothing, so the pins need not pull them there.
///
/// In:     `approach`: the problem without its rows and without the terms that belong to them;
///         starts without flipped triangles; with terms that keep borders from crossing, none may
///         cross.
/// Out:    `system`: a new one, left as it was at the end; the rest as `minimise`; its steps and
///         those of the approach are counted together. From any start the same optimum is reached,
///         as long as no border comes into contact.
/// Throws: Error{method_failed} if a start is folded; others as `minimise`.
[[nodiscard]] Minimum minimise_distortion(const Problem& approach, const Problem& problem,
                                          const std::vector<Chart>& starts,
                                          OptimalitySystem& system, const Progress& progress);

/// The same from where a search before ended, for a problem that has changed since; its charts are
/// moved to their pins. In and out, `system`: as `minimise`.
[[nodiscard]] Minimum minimise_distortion_again(const Problem& problem, const Iterate& from,
                                                OptimalitySystem& system, const Progress& progress);

}  // namespace lastflat
