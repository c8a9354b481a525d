// The faces of sole and top.
#pragma once

#include "core/landmarks/bare_last.h"

namespace lastflat {

/// Per face, whether it is of the sole, of the top; each is one piece without a hole.
struct SoleAndTop {
    std::vector<bool> sole, top;
};

/// Where the top is looked for among what faces up behind and above.
enum class TopChoice {
    flattest,
    highest,  ///< where the instep is broad and flat, too
};

/// Parts the faces by minimum cuts of their graph, in which it is cheap to part what meets at a
/// sharp convex edge: the sole from all that faces up or sideways, the top from the sides. Throws:
/// Error{region_invalid}.
[[nodiscard]] SoleAndTop sole_and_top(const SurfaceMesh& surface,
                                      const std::vector<BareFace>& faces, const LastFrame& frame,
                                      TopChoice choice);

/// The one line between the faces of a side and the others, as a closed path of vertices.
/// Throws: Error{region_invalid} if it is more than one line.
[[nodiscard]] std::vector<Index> line_around(const SurfaceMesh& surface,
                                             const std::vector<bool>& inside, const char* what);

}  // namespace lastflat
