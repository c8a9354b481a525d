#include "core/sample/spline.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lastflat {

namespace {

/// Solves a tridiagonal system by elimination without pivoting; spline systems are diagonally
/// dominant, so every pivot stays away from zero.
std::vector<double> solve_tridiagonal(const std::vector<double>& below,
                                      std::vector<double> diagonal,
                                      const std::vector<double>& above, std::vector<double> right) {
    const std::size_t n = diagonal.size();
    for (std::size_t i = 1; i < n; ++i) {
        const double factor = below[i] / diagonal[i - 1];
        diagonal[i] -= factor * above[i - 1];
        right[i] -= factor * right[i - 1];
    }
    for (std::size_t i = n; i-- > 0;) {
        const double known = i + 1 < n ? above[i] * right[i + 1] : 0.0;
        right[i] = (right[i] - known) / diagonal[i];
    }
    return right;
}

}  // namespace

CubicSpline::CubicSpline(std::vector<double> knots, std::vector<double> values, SplineEnd end)
    : knots_(std::move(knots)), values_(std::move(values)) {
    const std::size_t n = knots_.size();
    std::vector<double> below(n, 0.0), diagonal(n, 1.0), above(n, 0.0), right(n, 0.0);
    const auto width = [&](std::size_t i) { return knots_[i + 1] - knots_[i]; };
    const auto slope = [&](std::size_t i) { return (values_[i + 1] - values_[i]) / width(i); };
    // The first derivatives of neighbouring cubics agree at every inner knot.
    for (std::size_t i = 1; i + 1 < n; ++i) {
        below[i] = width(i - 1);
        diagonal[i] = 2.0 * (width(i - 1) + width(i));
        above[i] = width(i);
        right[i] = 6.0 * (slope(i) - slope(i - 1));
    }
    if (end == SplineEnd::level) {
        // The first derivative of the outer cubics is zero at the ends.
        diagonal[0] = 2.0 * width(0);
        above[0] = width(0);
        right[0] = 6.0 * slope(0);
        diagonal[n - 1] = 2.0 * width(n - 2);
        below[n - 1] = width(n - 2);
        right[n - 1] = -6.0 * slope(n - 2);
    }
    curvatures_ = solve_tridiagonal(below, std::move(diagonal), above, std::move(right));
}

double CubicSpline::operator()(double x) const {
    const double inside = std::clamp(x, knots_.front(), knots_.back());
    const auto next = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, inside);
    const auto i = static_cast<std::size_t>(next - knots_.begin()) - 1;
    const double width = knots_[i + 1] - knots_[i];
    const double b = (inside - knots_[i]) / width;
    const double a = 1.0 - b;
    // The chord, and the cubic whose second derivative runs straight between the two knots.
    return a * values_[i] + b * values_[i + 1] +
           ((a * a * a - a) * curvatures_[i] + (b * b * b - b) * curvatures_[i + 1]) * width *
               width / 6.0;
}

Vec3 wall_point(const WallControls& controls, double t) {
    constexpr std::size_t degree = 3;
    constexpr std::size_t spans = wall_controls - degree;
    const double position = std::clamp(t, 0.0, 1.0) * static_cast<double>(spans);
    const std::size_t span = std::min(static_cast<std::size_t>(position), spans - 1);
    // Knots 0 0 0 0 1 2 3 4 4 4 4: the repeated end knots pin the curve to its end points.
    const auto knot = [](std::size_t i) {
        return std::clamp(static_cast<double>(i) - static_cast<double>(degree), 0.0,
                          static_cast<double>(spans));
    };
    std::array<Vec3, degree + 1> points;
    for (std::size_t i = 0; i <= degree; ++i) points[i] = controls[span + i];
    // De Boor's algorithm: the control points of the span, averaged down to one point.
    for (std::size_t round = 1; round <= degree; ++round) {
        for (std::size_t i = degree; i >= round; --i) {
            const double low = knot(span + i);
            const double high = knot(span + i + degree + 1 - round);
            const double weight = (position - low) / (high - low);
            points[i] = (1.0 - weight) * points[i - 1] + weight * points[i];
        }
    }
    return points[degree];
}

double smooth_step(double x) {
    const double inside = std::clamp(x, 0.0, 1.0);
    return inside * inside * inside * (10.0 + inside * (6.0 * inside - 15.0));
}

}  // namespace lastflat
