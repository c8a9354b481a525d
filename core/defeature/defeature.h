// A workshop's last as the last-maker left it: without what was nailed to it, drilled and sawn.
#pragma once

#include "core/request.h"
#include "core/weld/surface_mesh.h"

namespace lastflat {

/// Takes away the small features of a closed surface and fills what is left over the rims' own
/// vertices with the least area [barequet-1995]: at most 15 mm across, or as large in area (a saw
/// cut). With `FeatureRule::automatic` only where the request leaves the curves to be found.
///
/// Out: `surface.filled` and the repair `features_filled` say where. Vertices keep their ids; those
///      of a feature are on no face any more.
void defeature(SurfaceMesh& surface, const Request& request);

}  // namespace lastflat
