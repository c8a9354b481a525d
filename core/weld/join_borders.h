// Borders that run along each other for a part of their way.
#pragma once

#include "core/weld/clean_faces.h"

namespace lastflat {

/// Vertices that face each other across a gap become one, halfway; a vertex beside an edge is put
/// into it, which bends the edge to the vertex; again until nothing is near any more. The gap is
/// not wider than `tolerance_mm`, and much narrower than the way along the border from one of its
/// sides to the other, so that a fine border does not join with itself. If that would leave an edge
/// with three sides, all is left as it was.
///
/// Out:    how far the furthest vertex or edge was moved, mm; the notes' counts.
double join_borders(Faces& faces, double tolerance_mm, RepairNote& joined, RepairNote& inserted);

}  // namespace lastflat
