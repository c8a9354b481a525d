// Based on: Floater, "Mean value coordinates", CAGD 2003.
#include <algorithm>
#include <cmath>

#include "core/numerics/tolerances.h"
#include "core/parameterize/weights.h"

namespace lastflat {

std::vector<double> mean_value_weights(const Star& star) {
    // A triangle's angle is below pi; scaled or measured in a degenerate layout it might reach it.
    constexpr double largest = tolerance::widest_angle;
    std::vector<double> weights(star.size(), 0.0);
    for (std::size_t j = 0; j < star.size(); ++j) {
        const double half_tangent = std::tan(0.5 * std::min(star.angles[j], largest));
        weights[j] += half_tangent / star.distances[j];
        weights[star.next(j)] += half_tangent / star.distances[star.next(j)];
    }
    return weights;
}

}  // namespace lastflat
