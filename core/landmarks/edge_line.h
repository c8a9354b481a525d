// Lines along the sharp edges of a last.
#pragma once

#include "core/landmarks/bare_last.h"
#include "core/locate/curves.h"

namespace lastflat {

/// From this share on a line is taken for sharp, and its gaps are bridged.
inline constexpr double mostly_sharp = 0.75;

struct EdgeLine {
    CurveSource curve;
    double confidence;  ///< how sure it is: the share of its length that is sharp
    bool evened;        ///< it has left the border of the faces all along, not at bridges alone
};

/// A closed line of a cut as a polyline. Sharp all the way, it goes from vertex to vertex. Where it
/// fades out and comes back, or runs over the filling of a feature, it follows the last of the edge
/// and bridges the rest as it went. Mostly smooth, it is evened out; on a noisy surface, or where
/// the vertices lie to and fro beside the edge, a sharp one, too, over half the length.
[[nodiscard]] EdgeLine edge_line(const SurfaceMesh& surface, const std::vector<BareFace>& faces,
                                 const std::string& name, const std::vector<Index>& line,
                                 bool noisy);

}  // namespace lastflat
