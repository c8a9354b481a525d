// The vertex from which the border is least far.
#pragma once

#include "core/cut/region.h"
#include "core/geodesic/exact_geodesics.h"

namespace lastflat {

struct GeodesicCentre {
    Index vertex = -1;
    double radius = 0.0;          ///< to the furthest border vertex, mm
    int runs = 0;                 ///< single-source computations that it took
    GeodesicDistances distances;  ///< from the centre
};

/// The inner vertex whose furthest border vertex is nearest (any vertex, where none is inner).
///
/// Paper:  [kim-kim], section 3.4: v* = argmin over i of max over border q of g(v_i, q). Found with
///         few single-source runs: a run from border vertex q bounds every vertex's radius from
///         below by g(q, .); the vertex of the least bound is tried, and its furthest border vertex
///         is the next to run from. Once the bound equals the radius, no other vertex can be
///         better.
/// Out:    exact up to `tolerance::geodesic_round_off`; of equal vertices the smallest id that is
///         tried first.
/// Throws: Error{canceled}; Error{solver_failed} as the distances do, or if the centre is not
/// found
///         in 64 runs: on tubes of perfect symmetry a whole ring of vertices ties.
[[nodiscard]] GeodesicCentre geodesic_centre(const Region& region, const ExactGeodesics& geodesics,
                                             const Progress& progress);

}  // namespace lastflat
