// Lines on the surface become edges of its triangulation.
#pragma once

#include "core/locate/curves.h"

namespace lastflat {

/// A path along edges of the surface; closed if the first vertex is also the last.
struct Curve {
    std::string name;
    std::vector<Index> vertices;
    [[nodiscard]] bool closed() const { return vertices.front() == vertices.back(); }
};

using Curves = std::vector<Curve>;

struct InsertedCurves {
    Curves curves;  ///< in the order of the lines
    /// Of the vertices that were added, in the order of their ids.
    std::vector<SurfacePoint> added;
    /// Of the triangles that were made; pi if there are none. Radians.
    double smallest_angle;
};

/// Splits triangles until every line runs along edges. The surface stays the same set of points:
/// new vertices lie on its edges and faces. Lines that cross or touch get a common vertex; what
/// comes nearer to a vertex or an edge than the line's `snap` is put there.
///
/// Throws: Error{curve_invalid} if a line meets itself other than by closing, or has no length.
[[nodiscard]] InsertedCurves insert_curves(SurfaceMesh& surface,
                                           const std::vector<SurfaceLine>& lines);

/// Puts more lines into a surface that has curves already; those go through the new vertices where
/// they meet the lines.
///
/// In:     what was put in before; lines on the surface as it is now.
/// Out:    all curves, the new ones last; all added vertices in terms of the vertices
///         before any curve.
[[nodiscard]] InsertedCurves insert_more_curves(SurfaceMesh& surface, InsertedCurves before,
                                                const std::vector<SurfaceLine>& lines);

}  // namespace lastflat
