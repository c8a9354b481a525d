// Closed-form singular value decomposition of 2x2 matrices.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace lastflat {

/// F = u diag(sigma) v^T with rotations u, v (determinant +1); so sigma[0] >= |sigma[1]|, and
/// sigma[1] has the sign of det F.
struct Svd2 {
    Eigen::Matrix2d u, v;
    Eigen::Vector2d sigma;
};

/// Splits F into a similarity (e, h) and an anti-similarity (f, g); their lengths are the mean and
/// half the difference of the singular values, their angles the sum and difference of the
/// rotations.
[[nodiscard]] inline Svd2 svd2(const Eigen::Matrix2d& matrix) {
    const double e = 0.5 * (matrix(0, 0) + matrix(1, 1));
    const double f = 0.5 * (matrix(0, 0) - matrix(1, 1));
    const double g = 0.5 * (matrix(1, 0) + matrix(0, 1));
    const double h = 0.5 * (matrix(1, 0) - matrix(0, 1));
    const double q = std::hypot(e, h);
    const double r = std::hypot(f, g);
    const double a1 = std::atan2(g, f);
    const double a2 = std::atan2(h, e);
    const double beta = 0.5 * (a2 + a1);   // angle of u
    const double gamma = 0.5 * (a2 - a1);  // angle of v^T
    Svd2 result;
    result.u << std::cos(beta), -std::sin(beta), std::sin(beta), std::cos(beta);
    result.v << std::cos(gamma), std::sin(gamma), -std::sin(gamma), std::cos(gamma);
    result.sigma = {q + r, q - r};
    return result;
}

}  // namespace lastflat
