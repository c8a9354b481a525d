// Quadratic equations.
#pragma once

#include <array>
#include <cmath>
#include <limits>

namespace lastflat {

/// The real roots of a t^2 + b t + c = 0, by the formula that does not cancel; infinite for each
/// that there is not.
[[nodiscard]] inline std::array<double, 2> quadratic_roots(double a, double b, double c) {
    constexpr double none = std::numeric_limits<double>::infinity();
    const double discriminant = b * b - 4.0 * a * c;
    if (discriminant < 0.0) return {none, none};
    const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
    return {a != 0.0 ? q / a : none, q != 0.0 ? c / q : none};
}

}  // namespace lastflat
