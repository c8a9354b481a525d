// A last whose top or sole the file does not have.
#pragma once

#include "core/request.h"
#include "core/weld/surface_mesh.h"

namespace lastflat {

/// Closes the only opening of a surface for which the request names no cuts, curves, regions or
/// groups, if it is a last then whose topline or featherline the rim is: what is put in takes no
/// part in the pattern. Any other surface stays as it is; one with two openings is an upper.
///
/// Out:    the repair `opening_closed` says what the rim was taken for.
/// Throws: Error{region_invalid} for a last with a hole elsewhere, far too small to be the border
///         of a piece, unless the request keeps holes.
void close_opening(SurfaceMesh& surface, const Request& request);

}  // namespace lastflat
