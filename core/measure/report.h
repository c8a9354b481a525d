// What the flattening did to the surface, recomputed from the result alone.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/measure/featherline.h"
#include "core/parameterize/chart.h"
#include "core/request.h"

namespace lastflat {

enum class Verdict { pass, warn, fail };

/// Distortion of one region; 1 or 0 is an isometry. See core/METHODS.md for the formulas.
struct Metrics {
    double stretch_l2, stretch_linf;                        ///< Sander et al., plane to surface
    double stretch_l2_normalised, stretch_linf_normalised;  ///< up to scale
    double symmetric_dirichlet;                             ///< mean density, a quarter of the sum
    double angle_distortion;                                ///< mean of (G/g + g/G) / 2
    double area_3d_mm2, area_2d_mm2;
    double area_error;      ///< |2D - 3D| / 3D
    double area_error_p95;  ///< 95 % of the surface has less
    Index flipped_triangles;
    Index border_crossings;
    std::optional<Verdict> area_verdict{};  ///< where a total area is asked
};

struct CurveReport {
    std::string name;
    bool locked;
    double length_3d_mm, length_2d_mm;
    double error_mm;                   ///< 2D minus 3D; of a curve that is not locked its ease
    double worst_edge_error_mm;        ///< largest |2D - 3D| of one edge
    std::optional<Verdict> verdict{};  ///< of its lock; what nobody locks has none
    std::vector<ZoneReport> zones{};   ///< of a featherline that nobody locks
};

/// Flat minus last, in percent of the last: above 0 the curve is gathered when it is lasted, below
/// 0 stretched.
[[nodiscard]] inline double ease_percent(double length_3d_mm, double length_2d_mm) {
    return 100.0 * (length_2d_mm - length_3d_mm) / length_3d_mm;
}

/// The two flat sides of one curve, to be sewn together.
struct PairReport {
    std::string curve;
    std::string a, b;      ///< regions
    double length_mm;      ///< on the last
    double difference_mm;  ///< flat length in a minus flat length in b
    Verdict verdict;
};

/// What one constraint came to, in one region; a match names the region of its first side.
struct ConstraintReport {
    std::size_t constraint;  ///< its index in the list
    std::string region;
    double asked_min, asked_max;  ///< mm, of an area mm^2; infinite: no bound
    double reached;
    double residual_mm;  ///< the worst of its parts, with its sign; of an area over its square root
    Vec3 position;       ///< of the worst part, on the last
    bool kept;           ///< to `tolerance::locked_length`
    bool relaxed = false;  ///< it gave way to others
};

/// Percent; so much of the area is below.
struct StretchPercentiles {
    double p01, p05, p50, p95, p99;
};

struct WorstStrain {
    Vec3 position;  ///< on the last, mm
    double larger_percent, smaller_percent;
};

/// What happens to the leather when the flat piece is lasted: along its two principal directions it
/// is stretched (above 0) where the pattern is smaller than the last, gathered (below 0) where it
/// is larger.
struct StretchReport {
    StretchPercentiles larger, smaller;
    StretchPercentiles area;  ///< strain of the leather's area
    /// Of the side of a last whose toe is known: what 99 % of the surface behind the toe does not
    /// strain by.
    std::optional<double> behind_toe_percent{};
    double most_stretched_percent;   ///< 0 or more
    double most_gathered_percent;    ///< 0 or less
    std::vector<WorstStrain> worst;  ///< ten at most, apart from each other, the worst first
    double beyond_material = 0.0;    ///< share of the area outside the limits
    std::optional<Verdict> material_verdict{};  ///< pass: none; warn: up to 1 % of the area
};

/// Paper: stretch [sander-2001]; the rest reading of [kim-kim], section 4.
[[nodiscard]] Metrics measure_distortion(const Region& region, const Points2& uv);

/// By how far the area lies beyond what a constraint asks: pass up to 0.5 % of the surface's, warn
/// up to 1.5 %. Nothing: no constraint asks.
[[nodiscard]] std::optional<Verdict> area_verdict(const Region& region, const Metrics& metrics,
                                                  const std::vector<Constraint>& constraints);

/// One entry per run of a named curve.
[[nodiscard]] std::vector<CurveReport> measure_curves(
    const Region& region, const Points2& uv, const std::vector<Constraint>& constraints,
    const std::optional<FeatherlineSide>& side = std::nullopt);

/// One entry per constraint and run or region that it binds.
[[nodiscard]] std::vector<ConstraintReport> measure_constraints(
    const std::vector<Region>& regions, const std::vector<Chart>& charts,
    const std::vector<Constraint>& constraints);

[[nodiscard]] StretchReport measure_stretch(
    const Region& region, const Points2& uv, const std::optional<MaterialLimits>& material,
    const std::optional<FeatherlineSide>& side = std::nullopt);

/// Every two runs along the same vertices of the last; and, as one that fails, every curve that two
/// regions share, but one has more of.
[[nodiscard]] std::vector<PairReport> measure_pairs(const std::vector<Region>& regions,
                                                    const std::vector<Chart>& charts);

}  // namespace lastflat
