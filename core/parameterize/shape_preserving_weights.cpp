// Based on: Floater, "Parametrization and smooth approximation of surface triangulations", CAGD
// 1997.
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/numerics/geometry.h"
#include "core/numerics/tolerances.h"
#include "core/parameterize/weights.h"

namespace lastflat {
namespace {

/// Directions of the spokes, scaled to go round once; the last entry is the first one again.
std::vector<double> polar_map(const Star& star) {
    const double total = std::accumulate(star.angles.begin(), star.angles.end(), 0.0);
    std::vector<double> directions{0.0};
    for (const double angle : star.angles) {
        directions.push_back(directions.back() + angle * 2.0 * std::numbers::pi / total);
    }
    directions.back() = 2.0 * std::numbers::pi;
    return directions;
}

}  // namespace

std::vector<double> shape_preserving_weights(const Star& star) {
    const std::size_t n = star.size();
    const auto directions = polar_map(star);
    for (std::size_t j = 0; j < n; ++j) {
        if (directions[j + 1] - directions[j] > tolerance::widest_angle)
            return mean_value_weights(star);
    }
    Points2 flat;
    for (std::size_t j = 0; j < n; ++j) {
        flat.emplace_back(star.distances[j] * std::cos(directions[j]),
                          star.distances[j] * std::sin(directions[j]));
    }
    std::vector<double> weights(n, 0.0);
    std::size_t facing =
        0;  // the triangle into which the line from spoke l through the centre runs
    for (std::size_t l = 0; l < n; ++l) {
        const double opposite = directions[l] + std::numbers::pi;
        const auto begin_of = [&](std::size_t j) {
            return directions[j % n] + (j >= n ? 2.0 * std::numbers::pi : 0.0);
        };
        facing = std::max(facing, l);
        while (begin_of(facing + 1) < opposite) ++facing;
        const std::size_t j = facing % n, k = star.next(j);
        const double of_l = cross(flat[j], flat[k]), of_j = cross(flat[k], flat[l]),
                     of_k = cross(flat[l], flat[j]);
        const double sum = (of_l + of_j + of_k) * static_cast<double>(n);
        weights[l] += of_l / sum;
        weights[j] += of_j / sum;
        weights[k] += of_k / sum;
    }
    return weights;
}

}  // namespace lastflat
