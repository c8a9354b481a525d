// Holes that cannot stay holes in the flat are opened by seams.
#pragma once

#include "core/cut/region.h"
#include "core/locate/surface_point.h"
#include "core/progress.h"
#include "core/request.h"

namespace lastflat {

/// A line between two border loops of a region, along which it is to be cut.
struct HoleSeam {
    std::string curve;                 ///< a curve that runs there already; else empty, and
    std::vector<SurfacePoint> points;  ///< the line, on vertices of the cut surface
    double length = 0.0;               ///< mm
    Vec3 position;                     ///< its middle
    double curvature = 0.0;            ///< that the hole stands for, radians
};

/// How much a region is curved where it has its holes: for each the Gaussian curvature, by its
/// integral, of any surface that would fill it. 0 for a hole in a plane or for a slit in it, a full
/// turn for the end of a tube, about half of one for the open top of a last. Radians.
[[nodiscard]] std::vector<double> hole_curvatures(const Region& region);

/// Whether the loop runs along both sides of cuts alone: it has no area, and its sides can close.
[[nodiscard]] bool is_slit(const Region& region, const std::vector<Index>& loop);

/// What joins the longest hole that is to be opened to the outer loop: a seam, or several, end to
/// end, where the way touches other loops; none: every hole is kept. Automatic: a hole is opened
/// if it stands for more than a quarter turn, either way. A slit never is.
///
/// The first such hole of a piece is opened along the curve `heel` if that joins it to the outer
/// loop; else, if the piece is long and the hole nearer to one end, as the top of a last is to its
/// heel, by the shortest path from the outermost vertex there. Any other hole is opened by the
/// shortest path from that vertex of the outer loop that is nearest along edges.
///
/// Throws: Error{canceled}.
[[nodiscard]] std::vector<HoleSeam> seams_of_next_hole(const Region& region, HoleRule rule,
                                                       bool is_first, const Progress& progress);

}  // namespace lastflat
