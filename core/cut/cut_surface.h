// A surface cut as it was planned.
#pragma once

#include "core/cut/insert_curves.h"
#include "core/cut/region.h"
#include "core/plan/plan.h"
#include "core/progress.h"

namespace lastflat {

struct CutSurface {
    InsertedCurves inserted;
    std::vector<Region> regions;
    std::vector<std::string> seams;  ///< the plan's, then those that opened holes
    std::vector<Warning> warnings;
};

/// Puts the curves into the surface, cuts it, and opens holes.
/// Throws: Error, as `locate_curves`, `insert_curves`, `cut_into_regions`;
///         Error{region_invalid} if found curves cannot be put in.
[[nodiscard]] CutSurface cut_surface(SurfaceMesh& surface, const Plan& plan,
                                     const Progress& progress);

}  // namespace lastflat
