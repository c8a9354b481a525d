// A last whose top or sole the file does not have.
#pragma once

#include "core/request.h"
#include "core/weld/surface_mesh.h"

namespace lastflat {

/// Closes the openings of an open surface for which the request names no cuts, curves, regions or
/// groups, if it is a last then whose topline or featherline every rim is: what is put in takes no
/// part in the pattern. Any other surface stays as it is.
///
/// Out:    the repair `openings_closed` says what each rim was taken for.
void close_openings(SurfaceMesh& surface, const Request& request);

}  // namespace lastflat
