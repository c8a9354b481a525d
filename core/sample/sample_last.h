// A shoe last of our own, made from formulas: something to try the program on, in any size.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/load/raw_mesh.h"
#include "core/numerics/types.h"
#include "core/request.h"

namespace lastflat {

enum class ToeShape { round, almond, pointed, square };

/// The shape a last-maker would be asked for. Lengths are mm.
struct SampleLastOptions {
    double size_eu = 42.0;         ///< Paris points, 30 to 50; one size is 20/3 mm of length and
                                   ///< 5 mm of girth
    double heel_height_mm = 20.0;  ///< how far the seat stands above the ball, 0 to 80
    double toe_spring_mm = 8.0;    ///< how far the toe point stands above the ball, 0 to 25
    double extra_girth_mm = 0.0;   ///< added to the girth of the size, -15 (slim) to 15 (wide)
    ToeShape toe = ToeShape::round;
};

/// A closed last and the curves a pattern is cut along.
struct SampleLast {
    /// Groups "upper", "sole" and "top" (label_sets, triangle_labels); coordinates in mm, rounded
    /// to 1e-4 mm, so that four decimals in a file say the same.
    RawMesh mesh;

    /// Vertex paths along mesh edges. `centre_front`: toe point over toe and instep to the topline.
    /// `heel`: the back curve from featherline to topline. `featherline`, `topline`: closed, from
    /// the back along the lateral side to the front and home along the medial side; the first
    /// vertex stands again at the end.
    std::vector<std::pair<std::string, std::vector<Index>>> curves;

    Index lateral_vertex = 0;  ///< well inside the lateral half of the upper
    Index medial_vertex = 0;   ///< well inside the medial half of the upper
};

/// Makes the right last of a pair; x runs from heel to toe, y to the medial side, z up, and z = 0
/// is the height of the feather edge at the ball.
///
/// In:     options within their ranges.
/// Out:    a closed manifold of about 10,000 triangles, counter-clockwise seen from outside. The
///         upper, opened along centre_front and heel, is two disks. A flat last (no heel, no toe
///         spring) has a featherline (20/3 size - 5) mm long from back to toe; a heel or a toe
///         spring bends the bottom but keeps its length along the foot. The same options give the
///         same bytes.
/// Throws: Error{unsupported_request} naming the option that is out of its range.
[[nodiscard]] SampleLast make_sample_last(const SampleLastOptions& options = {});

}  // namespace lastflat
