// Closed-form singular values of 2x2 matrices, and the directions along which they change.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace lastflat {

/// F = q A + r B with a rotation A = [c -s; s c], a reflection B = [c' s'; s' -c'] and q, r >= 0.
/// F stretches by q + r and q - r; the smaller has the sign of det F. The singular values grow
/// fastest along (A + B) / 2 and (A - B) / 2; along J A and J B, J a quarter turn, they rest.
///
/// No angle is computed: the rotations of the two sides enter as products only.
struct StretchFrame {
    double q, r;
    Eigen::Vector2d rotation;    ///< c, s
    Eigen::Vector2d reflection;  ///< c', s'; of a similarity (r = 0) any will do

    [[nodiscard]] double larger() const { return q + r; }
    [[nodiscard]] double smaller() const { return q - r; }
};

[[nodiscard]] inline StretchFrame stretch_frame(const Eigen::Matrix2d& F) {
    const Eigen::Vector2d similar(F(0, 0) + F(1, 1), F(1, 0) - F(0, 1));
    const Eigen::Vector2d opposite(F(0, 0) - F(1, 1), F(1, 0) + F(0, 1));
    const double q = std::sqrt(similar.squaredNorm()), r = std::sqrt(opposite.squaredNorm());
    StretchFrame frame{0.5 * q, 0.5 * r, Eigen::Vector2d::UnitX(), Eigen::Vector2d::UnitX()};
    if (q > 0.0) frame.rotation = similar / q;
    if (r > 0.0) frame.reflection = opposite / r;
    return frame;
}

}  // namespace lastflat
