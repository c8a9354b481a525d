#include "core/parameterize/weights.h"

#include <cmath>

#include "core/numerics/polygon.h"

namespace lastflat {

Star surface_star(const Region& region, const OneRings& rings, Index vertex) {
    Star star;
    const auto ring = rings.of(vertex);
    star.neighbours.assign(ring.begin(), ring.end());
    star.distances.reserve(ring.size());
    star.angles.reserve(ring.size());
    for (std::size_t j = 0; j < ring.size(); ++j) {
        star.distances.push_back(region.distance(vertex, ring[j]));
        star.angles.push_back(angle_at(region.position(vertex), region.position(ring[j]),
                                       region.position(ring[star.next(j)])));
    }
    return star;
}

OuterCotangents outer_cotangents(const Star& star, std::size_t j) {
    const double r = star.distances[j], s = star.distances[star.next(j)];
    const double along = s * std::cos(star.angles[j]), across = s * std::sin(star.angles[j]);
    // With the spoke j along x: the next neighbour lies at (along, across).
    return {(r - along) / across, (s * s - r * along) / (r * across)};
}

}  // namespace lastflat
