// From a mended surface to regions: what `flatten` and `inspect` do before all else.
#pragma once

#include "core/flatten.h"

namespace lastflat {

/// A request that says nothing of cuts, seams, regions or groups, of a closed last: what it would
/// have said is found (see `find_landmarks`) and filled in. Curves that it does name stand in for
/// those that would be found, which are not among those of the result; without constraints the
/// centre line is locked.
[[nodiscard]] std::optional<Landmarks> fill_in_landmarks(const SurfaceMesh& surface,
                                                         FlattenOptions& options);

/// How many of the curves, cuts and regions were found, not asked for by name.
enum class Found { none, some, all };

struct CutSurface {
    InsertedCurves inserted;
    std::vector<Region> regions;
    std::vector<Warning> warnings;
};

/// Puts the curves of the options into the surface, cuts it, and opens holes; every seam, whether
/// asked for or made, becomes a constraint. Constraints and zones are then known to fit the
/// regions.
/// Throws: Error, as `locate_curves`, `insert_curves`, `cut_into_regions`, `check_constraints`;
///         Error{region_invalid} if found curves cannot be put in.
[[nodiscard]] CutSurface cut_surface(SurfaceMesh& surface, FlattenOptions& options, Found found,
                                     const Progress& progress);

/// Ids of vertices that were welded away become the ids of those that stand for them.
void name_welded_vertices(const SurfaceMesh& surface, FlattenOptions& options);

}  // namespace lastflat
