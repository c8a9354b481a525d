// From regions to their charts under the constraints: the middle of the method.
#pragma once

#include "core/constrain/refine.h"
#include "core/fan/geodesic_fan.h"
#include "core/parameterize/start.h"
#include "core/prepare.h"

namespace lastflat {

/// Regions that depend on each other, by their indices, and their answer.
struct SolvedGroup {
    std::vector<std::size_t> regions;
    ConstrainedChart refined{};
};

/// Of whoever asked for it; nothing depends on it.
struct Fan {
    std::optional<GeodesicFan> fan;
    std::vector<Warning> warnings;
};

struct Solution {
    std::vector<SolvedGroup> groups;
    std::vector<Fan> fans;  ///< per region
};

/// What stays warm between two solves of the same regions: per group.
struct WarmGroup {
    std::vector<std::size_t> regions;
    Warmth warmth;
};
using WarmGroups = std::vector<WarmGroup>;

/// Per region. Throws: Error, as `start_chart`.
[[nodiscard]] std::vector<Start> start_charts(const Prepared& prepared, std::size_t threads,
                                              const Progress& progress);

/// From the starts to the answers of the plan's method. `left`: if not null, takes what stays warm.
/// Throws: Error, as `refine`; what is left is then empty.
[[nodiscard]] Solution solve(const Prepared& prepared, std::vector<Start> starts,
                             const FlattenOptions& options, const Progress& progress,
                             WarmGroups* left = nullptr);

/// From where a solve of the same regions ended; nothing if that does not lead to an answer.
/// Throws: Error, as `refine_again`.
[[nodiscard]] std::optional<Solution> solve_again(const Prepared& prepared,
                                                  const FlattenOptions& options,
                                                  const Progress& progress, WarmGroups& warm);

/// Makes the factors anew with which the next solve begins.
/// Throws: Error{canceled}.
void refresh(const Prepared& prepared, const FlattenOptions& options, const Progress& progress,
             WarmGroups& warm);

}  // namespace lastflat
