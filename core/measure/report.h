// What the flattening did to the surface, recomputed from the result alone.
#pragma once

#include <string>
#include <vector>

#include "core/constrain/constraint.h"
#include "core/parameterize/chart.h"

namespace lastflat {

enum class Verdict { pass, warn, fail };

/// Distortion of one region; 1 or 0 is an isometry. See core/README.md for the formulas.
struct Metrics {
    double stretch_l2, stretch_linf;                        ///< Sander et al., plane to surface
    double stretch_l2_normalised, stretch_linf_normalised;  ///< up to scale
    double symmetric_dirichlet;                             ///< mean density, a quarter of the sum
    double angle_distortion;                                ///< mean of (G/g + g/G) / 2
    double area_3d_mm2, area_2d_mm2;
    double area_error;      ///< |2D - 3D| / 3D
    double area_error_p95;  ///< 95 % of the surface has less
    Verdict area_verdict;
    Index flipped_triangles;
    Index border_crossings;
};

struct CurveReport {
    std::string name;
    bool locked;
    double length_3d_mm, length_2d_mm;
    double error_mm;             ///< 2D minus 3D
    double worst_edge_error_mm;  ///< largest |2D - 3D| of one edge
    Verdict verdict;
};

/// The two flat sides of one curve, to be sewn together.
struct PairReport {
    std::string curve;
    std::string a, b;      ///< regions
    double difference_mm;  ///< flat length in a minus flat length in b
    Verdict verdict;
};

/// Paper: stretch [sander-2001]; the rest reading of [kim-kim], section 4.
[[nodiscard]] Metrics measure_distortion(const Region& region, const Points2& uv);

/// One entry per run of a named curve.
[[nodiscard]] std::vector<CurveReport> measure_curves(const Region& region, const Points2& uv,
                                                      const std::vector<Constraint>& constraints);

/// Every two runs along the same vertices of the last.
[[nodiscard]] std::vector<PairReport> measure_pairs(const std::vector<Region>& regions,
                                                    const std::vector<Chart>& charts);

/// Per triangle, the principal stretch surface -> plane that is further from 1 (above: larger in
/// the flat).
[[nodiscard]] std::vector<double> signed_stretches(const Region& region, const Points2& uv);

}  // namespace lastflat
