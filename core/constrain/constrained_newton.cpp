// Based on: Smith, Schaefer, "Bijective Parameterization with Free Boundaries", SIGGRAPH 2015;
// Nocedal, Wright, "Numerical Optimization", 2006, chapters 15 and 18. Unlike both, Hessians are
// exact near the minimum whenever the system's inertia allows it.
#include "core/constrain/constrained_newton.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/constrain/optimality_system.h"
#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

/// Beyond this mean density the start is so far off that lengths are left alone at first.
constexpr double near_isometry = 1.05;
/// The approach ends when a step promises less than this share of the energy.
constexpr double approach_decrease = 1e-3;
/// A search that stalls has still converged if it stalls below this: round-off hides the rest.
constexpr double stalled_decrease = 1e-9;
constexpr int max_iterations = 200;

class ConstrainedNewton {
public:
    ConstrainedNewton(const Region& region, const std::vector<LengthConstraint>& constraints,
                      Distortion& distortion, const Progress& progress)
        : constraints_(constraints),
          distortion_(distortion),
          progress_(progress),
          system_(region, constraints, distortion),
          multipliers_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(constraints.size()))) {}

    /// Steps until no step promises more than `decrease` of the energy and all lengths are kept,
    /// or the mean density is below `enough`. False if progress ends before.
    bool run(Eigen::VectorXd& x, double decrease, double enough) {
        energy_ = distortion_.value(x);
        residual_ = system_.residual(x);
        while (iterations_ < max_iterations) {
            if (energy_ < enough * distortion_.total_area()) return true;
            progress_.check();
            const Step step = take_step(x);
            const bool at_rest = step.promised <= decrease * energy_;
            if (at_rest && worst_length_error() <= tolerance::solver_length) return true;
            if (step.length == 0.0) return step.promised <= stalled_decrease * energy_;
        }
        return false;
    }

    [[nodiscard]] double worst_length_error() const {
        double worst = 0.0;
        for (Eigen::Index k = 0; k < residual_.size(); ++k) {
            worst = std::max(
                worst, std::abs(residual_[k]) / constraints_[static_cast<std::size_t>(k)].length);
        }
        return worst;
    }
    [[nodiscard]] const Eigen::VectorXd& residual() const { return residual_; }
    [[nodiscard]] double energy() const { return energy_; }
    [[nodiscard]] int iterations() const { return iterations_; }
    /// The decrease of the merit function that the last step's model promised.
    [[nodiscard]] double promised() const { return promised_; }

private:
    [[nodiscard]] double merit(const Eigen::VectorXd& x) const {
        const double energy = distortion_.value(x);
        return std::isfinite(energy) ? energy + penalty_ * system_.residual(x).lpNorm<1>() : energy;
    }

    struct Step {
        double promised;  ///< decrease of the merit function, by the model
        double length;    ///< share of the step taken; 0: the merit function does not fall
    };

    /// One step of sequential quadratic programming.
    Step take_step(Eigen::VectorXd& x) {
        ++iterations_;
        system_.factor(x, multipliers_, near_ ? HessianKind::exact : HessianKind::projected);
        const Eigen::VectorXd solution = system_.solve(-system_.gradient(), -residual_);
        const Eigen::VectorXd d = solution.head(x.size());
        const Eigen::VectorXd wanted = solution.tail(residual_.size());
        if (wanted.size() > 0) {
            penalty_ = std::max(penalty_, 1.5 * wanted.lpNorm<Eigen::Infinity>());
        }
        const double slope = system_.gradient().dot(d) - penalty_ * residual_.lpNorm<1>();
        const double t = search(x, d, slope);
        multipliers_ += t * (wanted - multipliers_);
        energy_ = distortion_.value(x);
        residual_ = system_.residual(x);
        near_ = t == 1.0;
        promised_ = -0.5 * slope;
        return {promised_, t};
    }

    /// Moves x along d as far as the merit function falls; returns the step length.
    double search(Eigen::VectorXd& x, const Eigen::VectorXd& d, double slope) const {
        constexpr double armijo = 1e-4, round_off = 1e-13, smallest = 1e-10;
        const double before = merit(x);
        const double allowance = round_off * std::abs(before);
        const auto falls = [&](const Eigen::VectorXd& to, double t) {
            return merit(to) <= before + armijo * t * slope + allowance;
        };
        double t = std::min(1.0, 0.95 * distortion_.collapse_step(x, d));
        for (bool first = true; t > smallest; t *= 0.5, first = false) {
            Eigen::VectorXd to = x + t * d;
            bool accepted = falls(to, t);
            if (!accepted && first && t == 1.0 && residual_.size() > 0) {
                // Edges that turn by a finite angle come out too long: correct to second order.
                to += system_.solve(Eigen::VectorXd::Zero(x.size()), -system_.residual(to))
                          .head(x.size());
                accepted = falls(to, t);
            }
            if (accepted) {
                x = to;
                return t;
            }
        }
        return 0.0;
    }

    const std::vector<LengthConstraint>& constraints_;
    Distortion& distortion_;
    const Progress& progress_;
    OptimalitySystem system_;
    Eigen::VectorXd multipliers_, residual_;
    double energy_ = 0.0, penalty_ = 0.0, promised_ = 0.0;
    int iterations_ = 0;
    bool near_ = false;
};

Warning not_converged(const Region& region, const ConstrainedNewton& newton) {
    char decrease[48];
    std::snprintf(decrease, sizeof decrease, "%.2g", newton.promised() / newton.energy());
    return {"not_converged",
            "region '" + region.name + "' is sound but not at its minimum after " +
                std::to_string(newton.iterations()) +
                " Newton steps: its distortion could still fall by a share of " + decrease,
            std::nullopt};
}

[[noreturn]] void fail_infeasible(const Region& region,
                                  const std::vector<LengthConstraint>& constraints,
                                  const Eigen::VectorXd& residual) {
    Eigen::Index worst = 0;
    residual.cwiseAbs().maxCoeff(&worst);
    const auto& constraint = constraints[static_cast<std::size_t>(worst)];
    const Vec3& position = region.position(constraint.edges.front().first);
    char amount[48];
    std::snprintf(amount, sizeof amount, "%.3g mm", residual[worst]);
    throw Error(ErrorCode::constraints_infeasible,
                "region '" + region.name +
                    "': the locked lengths cannot all be kept; furthest off "
                    "is curve '" +
                    constraint.curve + "' at " + place(position) + ", by " + amount +
                    "; lock it by \"keep\": \"total\", or not at all")
        .at_option({"locks"})
        .at_position(position);
}

Eigen::VectorXd coordinates(const Points2& points) {
    Eigen::VectorXd x(2 * static_cast<Eigen::Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) {
        x.segment<2>(2 * static_cast<Eigen::Index>(i)) = points[i];
    }
    return x;
}

Points2 points_of(const Eigen::VectorXd& x) {
    Points2 points(static_cast<std::size_t>(x.size() / 2));
    for (std::size_t i = 0; i < points.size(); ++i) {
        points[i] = x.segment<2>(2 * static_cast<Eigen::Index>(i));
    }
    return points;
}

/// The uniform scale at which the chart has the surface's area.
double area_scale(const Region& region, const Points2& uv) {
    return std::sqrt(surface_area(region) / flat_area(region, uv));
}

}  // namespace

Minimum minimise_distortion(const Region& region, const Chart& start,
                            const std::vector<LengthConstraint>& constraints,
                            const IsotropicEnergy& energy, const Progress& progress) {
    const auto flipped = flipped_triangles(region, start.uv);
    if (!flipped.empty()) {
        throw Error(ErrorCode::method_failed,
                    std::to_string(flipped.size()) + " triangles of the start are flipped");
    }
    Distortion distortion(region, energy);
    Eigen::VectorXd x = area_scale(region, start.uv) * coordinates(start.uv);
    Minimum result;
    if (distortion.value(x) > near_isometry * distortion.total_area()) {
        const std::vector<LengthConstraint> none;
        ConstrainedNewton approach(region, none, distortion, progress);
        approach.run(x, approach_decrease, near_isometry);
        result.iterations = approach.iterations();
    }
    ConstrainedNewton newton(region, constraints, distortion, progress);
    const bool converged = newton.run(x, tolerance::newton_decrease, 0.0);
    if (newton.worst_length_error() > tolerance::locked_length) {
        fail_infeasible(region, constraints, newton.residual());
    }
    if (!converged) result.warnings.push_back(not_converged(region, newton));
    result.chart.uv = points_of(x);
    result.iterations += newton.iterations();
    result.energy = newton.energy() / distortion.total_area();
    result.worst_length_error = newton.worst_length_error();
    return result;
}

}  // namespace lastflat
