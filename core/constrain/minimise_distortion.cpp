#include "core/constrain/minimise_distortion.h"

#include <cmath>

#include "core/constrain/pins.h"
#include "core/error.h"

namespace lastflat {
namespace {

/// Far from an isometry a step is worth its while that promises this share of the distortion.
constexpr double approach_decrease = 1e-3;

Eigen::VectorXd scaled_starts(const Domain& domain, const std::vector<Chart>& starts) {
    Eigen::VectorXd x = domain.coordinates(starts);
    for (std::size_t r = 0; r < domain.regions.size(); ++r) {
        const Region& region = *domain.regions[r];
        const auto flipped = flipped_triangles(region, starts[r].uv);
        if (!flipped.empty()) {
            throw Error(ErrorCode::method_failed,
                        std::to_string(flipped.size()) + " triangles of the start are flipped");
        }
        const double scale = std::sqrt(surface_area(region) / flat_area(region, starts[r].uv));
        x.segment(2 * domain.first[r], 2 * (domain.first[r + 1] - domain.first[r])) *= scale;
    }
    return x;
}

Eigen::VectorXd moved_to_pins(const Problem& problem, const Eigen::VectorXd& x) {
    std::vector<Chart> charts = problem.domain.charts(x);
    for (std::size_t r = 0; r < charts.size(); ++r) {
        std::vector<PinnedVertex> pins;
        for (const Row& row : problem.rows) {
            const Coordinate* held = row.coordinate();
            if (held == nullptr || problem.domain.region_of(held->vertex) != r) continue;
            if (held->axis == 0)
                pins.push_back({held->vertex - problem.domain.first[r], Vec2(row.most, 0.0)});
            else
                pins.back().at.y() = row.most;
        }
        move_to_pins(pins, charts[r].uv);
    }
    return problem.domain.coordinates(charts);
}

}  // namespace

Minimum minimise_distortion(const Problem& approach, const Problem& problem,
                            const std::vector<Chart>& starts, OptimalitySystem& system,
                            const Progress& progress) {
    Eigen::VectorXd x = scaled_starts(problem.domain, starts);
    Minimum near;
    if (problem.distortion.value(x) > near_isometry * problem.distortion.total_area()) {
        OptimalitySystem without_rows;
        near = minimise(approach, Iterate::at(x, approach), {near_isometry, approach_decrease},
                        without_rows, progress);
        x = problem.domain.coordinates(near.charts);
    }
    Minimum minimum =
        minimise(problem, Iterate::at(moved_to_pins(problem, x), problem), {}, system, progress);
    minimum.iterations += near.iterations;
    return minimum;
}

Minimum minimise_distortion_again(const Problem& problem, const Iterate& from,
                                  OptimalitySystem& system, const Progress& progress) {
    const Approach near{0.0, 0.0, tolerance::live_gradient, tolerance::live_length};
    return minimise(problem, {moved_to_pins(problem, from.x), from.multipliers}, near, system,
                    progress);
}

}  // namespace lastflat
