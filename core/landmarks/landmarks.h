// What is what on a bare last.
#pragma once

#include <string>

#include "core/cut/cut.h"
#include "core/locate/curves.h"
#include "core/progress.h"

namespace lastflat {

enum class Foot { left, right };

/// Below this confidence it is said that lateral and medial may be the other way round.
inline constexpr double sure_of_sides = 0.3;

struct Landmarks {
    Foot foot = Foot::right;
    Vec3 up, forward;            ///< unit vectors: from the sole to the cone, from heel to toe
    Vec3 heel_point, toe_point;  ///< on the featherline
    // How sure each is, 0 to 1; less than `mostly_sharp` or `sure_of_sides` is a warning.
    double featherline_confidence = 0.0;  ///< by how sharp the edge is along it
    double topline_confidence = 0.0;
    double sides_confidence = 0.0;    ///< by how much wider one side of the waist is
    std::vector<CurveSource> curves;  ///< featherline, topline, centre_front, heel
    CutOptions cut;                   ///< regions lateral and medial
    std::vector<Warning> warnings;
};

/// Finds featherline, topline, centre line, sides and foot on a closed last, wherever it lies.
///
/// The sole is the great flat side, the cone is above the heel. Featherline and topline are minimum
/// cuts of the graph of faces between the sole, the sides and the top: short lines that keep to
/// sharp edges. On a noisy surface both are looked for with the noise taken out of the normals, on
/// any by what stands out from its own bends; where an edge fades on such a surface, it is doubted
/// twice. The centre line is the section with the upright plane through the two points of the
/// featherline that are furthest apart. The lateral side is the one where the waist is wider.
///
/// Throws: Error{region_invalid}, saying what is needed, if the surface is open, in several pieces,
///         or has no such sides.
[[nodiscard]] Landmarks find_landmarks(const SurfaceMesh& surface,
                                       const Progress& progress = Progress(),
                                       std::size_t threads = 1);

/// Of a curve that was found: all of them are polylines.
[[nodiscard]] const Points3& points_of(const CurveSource& found);

}  // namespace lastflat
