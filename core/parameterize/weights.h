// The weights of the convex combination family: one function each, from the star of a vertex.
#pragma once

#include <vector>

#include "core/cut/region.h"

namespace lastflat {

/// A star of directions around a vertex: its neighbours with their distances, and the angle between
/// each neighbour and the next. Neighbour j spans triangle j with the next one.
struct Star {
    std::vector<Index> neighbours;
    std::vector<double> distances;
    std::vector<double> angles;  ///< as many as neighbours: the star is closed

    [[nodiscard]] std::size_t size() const { return neighbours.size(); }
    [[nodiscard]] std::size_t next(std::size_t j) const { return j + 1 < size() ? j + 1 : 0; }
    [[nodiscard]] std::size_t previous(std::size_t j) const { return (j > 0 ? j : size()) - 1; }
};

/// The star of an inner vertex as it is on the surface: 3D distances, 3D angles.
[[nodiscard]] Star surface_star(const Region& region, Index vertex);

/// One weight for each neighbour, not normalised.
using WeightRule = std::vector<double> (*)(const Star& star);

/// w_j = 1. Positive.
/// Paper: [tutte-1963].
[[nodiscard]] std::vector<double> tutte_weights(const Star& star);

/// w_j = 1 / r_j. Positive.
/// Paper: [floater-1997], section 4 (weighted least squares of edge lengths, exponent 1).
[[nodiscard]] std::vector<double> chord_length_weights(const Star& star);

/// The star is laid into the plane by its geodesic polar map (distances kept, angles scaled to go
/// round once); the weights are the means of the barycentric coordinates of its centre in all
/// triangles (p_l, p_j, p_j+1) that contain it, one for each neighbour l. Positive. Where one angle
/// of the map reaches pi (a concave border), no triangle contains it: mean value weights instead.
/// Paper: [floater-1997], section 6.
[[nodiscard]] std::vector<double> shape_preserving_weights(const Star& star);

/// w_j = cot a + cot b, a and b the angles that face spoke j. Negative where a + b > pi.
/// Paper: [eck-1995]; cotangents: [pinkall-1993].
[[nodiscard]] std::vector<double> harmonic_weights(const Star& star);

/// w_j = (cot a + cot b) / r_j^2, a and b the angles beside spoke j at its far end. Negative where
/// a + b > pi: the star is not convex there.
/// Paper: [meyer-2002].
[[nodiscard]] std::vector<double> wachspress_weights(const Star& star);

/// w_j = (tan(a_{j-1} / 2) + tan(a_j / 2)) / r_j. Positive while all angles are below pi.
/// Paper: [floater-2003], formula 2.1 (theorem 1).
[[nodiscard]] std::vector<double> mean_value_weights(const Star& star);

/// Cotangents of the two outer angles of triangle j: at neighbour j, and at the next one.
struct OuterCotangents {
    double here, next;
};
[[nodiscard]] OuterCotangents outer_cotangents(const Star& star, std::size_t j);

}  // namespace lastflat
