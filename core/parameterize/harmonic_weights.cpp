// Based on: Eck, DeRose, Duchamp, Hoppe, Lounsbery, Stuetzle, "Multiresolution Analysis of
// Arbitrary Meshes", SIGGRAPH 1995; Pinkall, Polthier, "Computing Discrete Minimal Surfaces",
// Experimental Mathematics 1993.
#include "core/parameterize/weights.h"

namespace lastflat {

std::vector<double> harmonic_weights(const Star& star) {
    std::vector<double> weights(star.size(), 0.0);
    for (std::size_t j = 0; j < star.size(); ++j) {
        const OuterCotangents cotangents = outer_cotangents(star, j);
        weights[j] += cotangents.next;
        weights[star.next(j)] += cotangents.here;
    }
    return weights;
}

}  // namespace lastflat
