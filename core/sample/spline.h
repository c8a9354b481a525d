// Smooth curves through or near a few hand-chosen numbers: what the shape of the last is made of.
#pragma once

#include <array>
#include <vector>

#include "core/numerics/types.h"

namespace lastflat {

/// How a spline leaves its two end knots.
enum class SplineEnd {
    level,     ///< slope zero: the mirror image joins on smoothly (an even function)
    straight,  ///< curvature zero: the point reflection joins on smoothly (an odd function)
};

/// A function of one variable through given values, twice continuously differentiable.
class CubicSpline {
public:
    /// In: two or more strictly increasing knots, one value for each.
    CubicSpline(std::vector<double> knots, std::vector<double> values, SplineEnd end);

    /// The value at `x`, which is first brought into the range of the knots.
    [[nodiscard]] double operator()(double x) const;

private:
    std::vector<double> knots_;
    std::vector<double> values_;
    std::vector<double> curvatures_;  ///< second derivative at each knot
};

/// The number of control points of a wall curve.
inline constexpr std::size_t wall_controls = 7;
using WallControls = std::array<Vec3, wall_controls>;

/// A point of the uniform cubic B-spline that starts at the first and ends at the last control
/// point. In: `t` in [0, 1].
[[nodiscard]] Vec3 wall_point(const WallControls& controls, double t);

/// 0 below zero, 1 above one, and between them a step whose first two derivatives vanish at both
/// ends, so that whatever it blends stays twice continuously differentiable.
[[nodiscard]] double smooth_step(double x);

}  // namespace lastflat
