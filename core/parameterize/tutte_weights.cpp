// Based on: Tutte, "How to Draw a Graph", Proceedings of the London Mathematical Society 1963.
#include "core/parameterize/weights.h"

namespace lastflat {

std::vector<double> tutte_weights(const Star& star) {
    return std::vector<double>(star.size(), 1.0);
}

}  // namespace lastflat
