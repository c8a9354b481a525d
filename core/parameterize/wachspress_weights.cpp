// Based on: Meyer, Lee, Barr, Desbrun, "Generalized Barycentric Coordinates on Irregular Polygons",
// Journal of Graphics Tools 2002.
#include "core/parameterize/weights.h"

namespace lastflat {

std::vector<double> wachspress_weights(const Star& star) {
    std::vector<double> weights(star.size(), 0.0);
    for (std::size_t j = 0; j < star.size(); ++j) {
        const OuterCotangents cotangents = outer_cotangents(star, j);
        weights[j] += cotangents.here;
        weights[star.next(j)] += cotangents.next;
    }
    for (std::size_t j = 0; j < star.size(); ++j) {
        weights[j] /= star.distances[j] * star.distances[j];
    }
    return weights;
}

}  // namespace lastflat
