// What the stages of the search see of a bare last.
#pragma once

#include "core/locate/surface_point.h"

namespace lastflat {

/// Throws: Error{region_invalid}: the curves cannot be found, why, and what is needed.
[[noreturn]] void fail_search(const std::string& why);

struct BareFace {
    Vec3 centre, normal;
    double area;
};

[[nodiscard]] std::vector<BareFace> bare_faces(const SurfaceMesh& surface);

/// The last's own directions, wherever it lies.
struct LastFrame {
    Vec3 forward, up;  ///< from heel to toe, from the sole to the cone
};

/// How the last may lie, the likeliest first. The long axis is its length, a great flat side its
/// sole, and the cone is over the heel; a flank may be as flat as the sole. Throws:
/// Error{region_invalid}.
[[nodiscard]] std::vector<LastFrame> last_frames(const std::vector<BareFace>& faces);

/// The faces of a set that hang together with the given one.
[[nodiscard]] std::vector<bool> piece_of(const SurfaceMesh& surface, const std::vector<bool>& set,
                                         std::size_t seed);

[[nodiscard]] Points3 positions_of(const SurfaceMesh& surface, const std::vector<Index>& line);

}  // namespace lastflat
