// Based on: Floater, "Parametrization and smooth approximation of surface triangulations", CAGD
// 1997.
#include "core/parameterize/weights.h"

namespace lastflat {

std::vector<double> chord_length_weights(const Star& star) {
    std::vector<double> weights;
    for (const double distance : star.distances) weights.push_back(1.0 / distance);
    return weights;
}

}  // namespace lastflat
