// How much the flat border turns at each of its vertices.
#pragma once

#include "core/cut/region.h"
#include "core/numerics/surface_elimination.h"
#include "core/request.h"

namespace lastflat {

struct BorderAngles {
    std::vector<double> turning;  ///< per border vertex, its exterior angle; their sum is 2 pi
    /// Per border vertex, the angles of its triangles in the flat, in the order of its ring; they
    /// add up to pi - turning, or to 0.001 where that would be less.
    std::vector<std::vector<double>> corners;
};

/// Angles of the flat border.
///
/// Paper:  `curvature`: [sawhney-2017], section 4 (Cherrier's formula): with the cotangent
///         Laplacian A, A u = -Gauss curvature inside, u = 0 on the border; the turning becomes
///         k + A u. `averaged_conformal`: [kim-kim], section 3.3; what is missing from 2 pi is
///         spread over the border in proportion to its length.
/// In:     a region (a disk), its `dissection_of`.
/// Throws: Error{solver_failed}.
[[nodiscard]] BorderAngles border_angles(const Region& region, const Dissection& dissection,
                                         AngleRule rule);

}  // namespace lastflat
