#include "core/parameterize/weights.h"

#include <cmath>

#include "core/numerics/geometry.h"

namespace lastflat {

Star surface_star(const Region& region, Index vertex) {
    Star star;
    star.neighbours = region.half_edges.ring(vertex);
    const auto& ring = star.neighbours;
    const std::size_t n = ring.size();
    star.distances.resize(n);
    star.angles.resize(n);
    const Vec3& centre = region.position(vertex);
    const Vec3 first = region.position(ring[0]) - centre;
    Vec3 spoke = first;
    for (std::size_t j = 0; j < n; ++j) {
        const Vec3 next = j + 1 < n ? Vec3(region.position(ring[j + 1]) - centre) : first;
        star.distances[j] = spoke.norm();
        star.angles[j] = angle_between(spoke, next);
        spoke = next;
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
