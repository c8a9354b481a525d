// Patches whose borders run along each other become one surface.
#pragma once

#include "core/weld/clean_faces.h"

namespace lastflat {

/// Puts border vertices into the border edges that they lie on, where a coarser face meets finer
/// ones.
void close_t_junctions(Faces& faces, double tolerance_mm, std::vector<Repair>& repairs);

/// Closes gaps between borders. Border vertices of one and the same position become one; two loops
/// that then run along each other all the way, nowhere further apart than `tolerance_mm`, become
/// one line of edges halfway between them. A vertex without a partner on the other side is put into
/// the edge that it lies beside (T-junctions). What is left, borders that run along each other for
/// a part of their way, goes to `join_borders`. Vertices keep their ids; none is added.
void stitch(Faces& faces, double tolerance_mm, std::vector<Repair>& repairs);

}  // namespace lastflat
