// Based on: Smith, Schaefer, "Bijective Parameterization with Free Boundaries", SIGGRAPH 2015;
// Nocedal, Wright, "Numerical Optimization", 2006, chapters 15 and 18; Hintermueller, Ito, Kunisch,
// "The Primal-Dual Active Set Strategy as a Semismooth Newton Method", SIAM J. Optimization 2002.
// Unlike the first, Hessians are exact near the minimum whenever the system's inertia allows it.
#include "core/constrain/constrained_newton.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/constrain/optimality_system.h"
#include "core/constrain/place_start.h"
#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

/// Beyond this mean density the start is so far off that constraints are left alone at first.
constexpr double near_isometry = 1.05;
/// The approach ends when a step promises less than this share of the energy.
constexpr double approach_decrease = 1e-3;
constexpr int max_iterations = 300;
/// Below this sum of projected gradient and error the first-order conditions are solved directly.
constexpr double nearly_optimal = 1e-3;
/// An inequality that was let go so often stays: it would come and go forever.
constexpr int most_releases = 8;
/// Constraints that contradict each other pull with forces beyond this many times the size of the
/// surface; or their error has not fallen by a tenth within so many steps.
constexpr double greatest_force = 1e3;
constexpr int patience = 15;

using Eigen::VectorXd;

class ConstrainedNewton {
public:
    ConstrainedNewton(const Problem& problem, Distortion& distortion, const VectorXd& x,
                      const Progress& progress)
        : rows_(problem.rows),
          compliance_(problem.compliance.empty() ? std::vector<double>(rows_.size(), 0.0)
                                                 : problem.compliance),
          distortion_(distortion),
          progress_(progress),
          contact_(problem.contact ? std::make_optional<BorderContact>(problem.domain)
                                   : std::nullopt),
          stiff_curves_(problem.stiff_curves),
          system_(problem.domain, rows_, compliance_, distortion, contact_ ? &*contact_ : nullptr,
                  problem.stiff_curves, x, problem.threads, progress),
          multipliers_(VectorXd::Zero(static_cast<Eigen::Index>(rows_.size()))),
          held_(rows_.size(), Held::not_held),
          releases_(rows_.size(), 0) {
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            if (rows_[k].is_equation()) held_[k] = Held::by_most;
        }
    }

    /// Steps until the projected gradient and the errors are as small as asked, or the mean density
    /// is below `enough`. False if progress ends before.
    bool run(VectorXd& x, double decrease, double enough) {
        move_to(x);
        near_ = energy_ < near_isometry * distortion_.total_area();
        while (iterations_ < max_iterations) {
            if (energy_ < enough * distortion_.total_area()) return true;
            if (update_held()) move_to(x);
            if (is_optimal()) return true;
            progress_.check();
            const Step step = take_step(x);
            if (has_stalled(step.promised)) return true;
            if (decrease > 0.0 && step.promised < decrease * energy_) return true;
            contradictory_ = hopeless();
            if (contradictory_) return false;
            if (step.length == 1.0 && distance_to_optimum() <= nearly_optimal) solve_conditions(x);
            if (step.length == 0.0 && hold_blocking(x)) continue;
            if (step.length == 0.0) return projected_gradient_ <= tolerance::stalled_gradient;
        }
        return false;
    }

    void report(Minimum& minimum) const {
        minimum.iterations += iterations_;
        minimum.factorizations += factorizations_;
        minimum.energy = energy_ / distortion_.total_area();
        minimum.projected_gradient = projected_gradient_;
        minimum.worst_error = worst_error_;
        minimum.contradictory = contradictory_;
        minimum.errors = VectorXd(static_cast<Eigen::Index>(rows_.size()));
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            const auto i = static_cast<Eigen::Index>(k);
            minimum.errors[i] = rows_[k].violation(values_[i]);
        }
    }

private:
    /// Whether steps have long promised nothing but round-off: needles stop the gradient's fall.
    [[nodiscard]] bool has_stalled(double promised) {
        const bool idle = promised <= 1e-15 * energy_ && !undecided_ &&
                          std::max(projected_gradient_ / tolerance::stalled_gradient,
                                   worst_error_ / tolerance::solver_length) <= 1.0;
        return (idle_steps_ = idle ? idle_steps_ + 1 : 0) > 3;
    }

    /// Whether the constraints seem to contradict each other.
    [[nodiscard]] bool hopeless() {
        if (worst_error_ <= tolerance::locked_length) {
            least_error_ = std::numeric_limits<double>::infinity();
            least_at_ = iterations_;
            return false;
        }
        if (worst_error_ < 0.9 * least_error_) {
            least_error_ = worst_error_;
            least_at_ = iterations_;
        }
        if (blocked_) least_at_ = iterations_;  // contact makes steps short, whatever is asked
        double force = 0.0;
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            if (!soft(k))
                force = std::max(force, std::abs(multipliers_[static_cast<Eigen::Index>(k)]));
        }
        return force > greatest_force * std::sqrt(distortion_.total_area()) ||
               iterations_ - least_at_ >= patience;
    }

    struct Step {
        double promised;  ///< decrease of the merit function, by the model
        double length;    ///< share of the step taken; 0: the merit function does not fall
    };

    [[nodiscard]] bool soft(std::size_t k) const { return compliance_[k] > 0.0; }

    [[nodiscard]] VectorXd row_values(const VectorXd& x) const {
        VectorXd values(static_cast<Eigen::Index>(rows_.size()));
        for (std::size_t k = 0; k < rows_.size(); ++k)
            values[static_cast<Eigen::Index>(k)] = rows_[k].value(x);
        return values;
    }

    /// Per row, how far it is from the bound that holds it.
    [[nodiscard]] VectorXd residual(const VectorXd& values) const {
        VectorXd result = VectorXd::Zero(values.size());
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            const auto i = static_cast<Eigen::Index>(k);
            if (held_[k] == Held::by_most) result[i] = values[i] - rows_[k].most;
            if (held_[k] == Held::by_least) result[i] = values[i] - rows_[k].least;
        }
        return result;
    }

    /// The residual of exact rows; a soft one's force is its error, so nothing of it is left.
    [[nodiscard]] VectorXd exact_errors(const VectorXd& values) const {
        VectorXd errors = residual(values);
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            if (soft(k)) errors[static_cast<Eigen::Index>(k)] = 0.0;
        }
        return errors;
    }

    /// What the constraints add to the merit function.
    [[nodiscard]] double cost_of(const VectorXd& values) const {
        double cost = 0.0;
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            const double error = rows_[k].violation(values[static_cast<Eigen::Index>(k)]);
            cost += soft(k) ? 0.5 * error * error / compliance_[k] : penalty_ * std::abs(error);
        }
        return cost;
    }

    [[nodiscard]] double merit(const VectorXd& x) const {
        const double energy = distortion_.value(x);
        if (!std::isfinite(energy)) return energy;
        return energy + cost_of(row_values(x)) + (contact_ ? contact_->value(x) : 0.0) +
               (stiff_curves_ != nullptr ? stiff_curves_->value(x) : 0.0);
    }

    /// Evaluates everything at x, which then is where the search stands.
    void move_to(const VectorXd& x) {
        energy_ = distortion_.value(x);
        gradient_ = distortion_.gradient(x);
        if (contact_) contact_->add_gradient(x, gradient_);
        if (stiff_curves_ != nullptr) stiff_curves_->add_gradient(x, gradient_);
        values_ = row_values(x);
        const VectorXd errors = residual(values_);
        worst_error_ = 0.0;
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            const auto i = static_cast<Eigen::Index>(k);
            if (soft(k)) {
                multipliers_[i] = errors[i] / compliance_[k];
            } else {
                worst_error_ = std::max(
                    worst_error_, std::abs(rows_[k].violation(values_[i])) / rows_[k].reference);
            }
        }
        VectorXd forces = gradient_;
        system_.add_forces(x, multipliers_, forces);
        projected_gradient_ = forces.norm() / std::sqrt(distortion_.total_area());
    }

    /// Holds what is violated, lets go what pulls the wrong way. Whether anything changed.
    bool update_held() {
        bool changed = false;
        undecided_ = false;
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            if (rows_[k].is_equation()) continue;
            const auto i = static_cast<Eigen::Index>(k);
            Held now = held_[k];
            const bool pulls_in = static_cast<double>(now) * multipliers_[i] < 0.0;
            undecided_ = undecided_ || (pulls_in && releases_[k] >= most_releases);
            if (pulls_in && releases_[k] < most_releases) {
                now = Held::not_held;
                multipliers_[i] = 0.0;
                ++releases_[k];
            } else if (const double error = rows_[k].violation(values_[i]);
                       std::abs(error) > tolerance::solver_length * rows_[k].reference) {
                now = error > 0.0 ? Held::by_most : Held::by_least;
            }
            changed = changed || now != held_[k];
            held_[k] = now;
        }
        return changed;
    }

    /// Where no part of the last step could be taken: holds the rows at their bounds that it would
    /// have broken. Whether there are any.
    [[nodiscard]] bool hold_blocking(const VectorXd& x) {
        const VectorXd values = row_values(x + direction_);
        bool found = false;
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            if (held_[k] != Held::not_held || releases_[k] >= most_releases) continue;
            const double error = rows_[k].violation(values[static_cast<Eigen::Index>(k)]);
            if (std::abs(error) <= tolerance::solver_length * rows_[k].reference) continue;
            held_[k] = error > 0.0 ? Held::by_most : Held::by_least;
            found = true;
        }
        return found;
    }

    /// One step of sequential quadratic programming.
    Step take_step(VectorXd& x) {
        ++iterations_;
        ++factorizations_;
        system_.prepare(x);
        system_.factor(x, multipliers_, held_, near_ ? HessianKind::exact : HessianKind::projected);
        const VectorXd errors = residual(values_);
        const VectorXd solution = system_.solve(-gradient_, -errors);
        const VectorXd d = solution.head(x.size());
        direction_ = d;
        const VectorXd wanted = solution.tail(errors.size());
        double slope = gradient_.dot(d), force = 0.0;
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            const auto i = static_cast<Eigen::Index>(k);
            if (soft(k)) {
                slope += multipliers_[i] * (compliance_[k] * wanted[i] - errors[i]);
            } else {
                force = std::max(force, std::abs(wanted[i]));
            }
        }
        penalty_ =
            std::max(1.5 * force, 0.5 * penalty_);  // a great force may have been a passing one
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            if (!soft(k))
                slope -=
                    penalty_ * std::abs(rows_[k].violation(values_[static_cast<Eigen::Index>(k)]));
        }
        const double t = search(x, d, slope);
        multipliers_ += t * (wanted - multipliers_);
        move_to(x);
        near_ = t == 1.0;
        return {-0.5 * slope, t};
    }

    [[nodiscard]] bool is_optimal() const {
        return !undecided_ && projected_gradient_ <= tolerance::projected_gradient &&
               worst_error_ <= tolerance::solver_length;
    }

    /// How far the point is from one that satisfies the first-order conditions.
    [[nodiscard]] double distance_to_optimum() const { return projected_gradient_ + worst_error_; }

    /// Newton's method on the first-order conditions themselves, for as long as it brings them
    /// nearer by much: no line search, and the sign of the curvature does not matter. A locked
    /// curve under compression whose edges are short would rather fold up like a concertina;
    /// these steps keep to the smooth curve.
    void solve_conditions(VectorXd& x) {
        reuse_factor(x);
        while (!is_optimal()) {
            progress_.check();
            ++factorizations_;
            if (!system_.factor_exact(x, multipliers_, held_) || !step_to_conditions(x)) return;
            reuse_factor(x);
        }
    }
    /// Further steps with the last factor, whose matrix has hardly changed (the chord method).
    void reuse_factor(VectorXd& x) {
        while (!is_optimal() && step_to_conditions(x)) {
        }
    }

    /// One full step with the last factor; false, and nothing happens, if it does not bring the
    /// conditions nearer by much. It corrects what is left of the Lagrangian's gradient, so that an
    /// old matrix does not tilt the multipliers.
    bool step_to_conditions(VectorXd& x) {
        constexpr double much = 0.1;
        const double before = distance_to_optimum();
        const VectorXd start = x, multipliers = multipliers_;
        VectorXd forces = gradient_;
        system_.add_forces(x, multipliers_, forces);
        const VectorXd solution = system_.solve(-forces, -exact_errors(values_));
        x += solution.head(x.size());
        if (reaches(start, x) && std::isfinite(distortion_.value(x))) {
            multipliers_ += solution.tail(values_.size());
            move_to(x);
            if (distance_to_optimum() <= much * before) {
                ++iterations_;
                return true;
            }
        }
        x = start;
        multipliers_ = multipliers;
        move_to(x);
        return false;
    }

    /// Moves x along d as far as the merit function falls; returns the step length.
    double search(VectorXd& x, const VectorXd& d, double slope) {
        constexpr double armijo = 1e-4, round_off = 1e-13, smallest = 1e-10;
        const double before = merit(x);
        const double allowance = round_off * std::abs(before);
        const auto falls = [&](const VectorXd& to, double t) {
            return merit(to) <= before + armijo * t * slope + allowance;
        };
        double t = std::min(1.0, 0.95 * distortion_.collapse_step(x, d));
        const double free = contact_ ? contact_->collision_step(x, t * d) : 1.0;
        blocked_ = free < 1.0;
        t *= free;
        for (bool first = true; t > smallest; t *= 0.5, first = false) {
            VectorXd to = x + t * d;
            bool accepted = falls(to, t);
            if (!accepted && first && t == 1.0 && !rows_.empty()) {
                // Edges that turn by a finite angle come out too long: correct to second order.
                to += system_.solve(VectorXd::Zero(x.size()), -exact_errors(row_values(to)))
                          .head(x.size());
                accepted = reaches(x, to) && falls(to, t);
            }
            if (accepted) {
                x = to;
                return t;
            }
        }
        return 0.0;
    }

    /// Whether nothing collides on the straight way.
    [[nodiscard]] bool reaches(const VectorXd& x, const VectorXd& to) const {
        return !contact_ || contact_->collision_step(x, to - x) == 1.0;
    }

    const std::vector<ConstraintRow>& rows_;
    const std::vector<double> compliance_;
    Distortion& distortion_;
    const Progress& progress_;
    std::optional<BorderContact> contact_;
    const StiffCurves* stiff_curves_;
    OptimalitySystem system_;
    VectorXd multipliers_, gradient_, values_;
    VectorXd direction_;  ///< of the last step
    std::vector<Held> held_;
    std::vector<int> releases_;
    double energy_ = 0.0, penalty_ = 0.0, projected_gradient_ = 0.0, worst_error_ = 0.0;
    double least_error_ = std::numeric_limits<double>::infinity();
    int iterations_ = 0, factorizations_ = 0, least_at_ = 0, idle_steps_ = 0;
    bool near_ = false;
    bool blocked_ = false;  ///< the last step would have led to a collision
    bool contradictory_ = false;
    bool undecided_ = false;  ///< an inequality that pulls the wrong way and is not let go any more
};

}  // namespace

Minimum minimise_distortion(const Problem& problem, const std::vector<Chart>& starts,
                            const Progress& progress) {
    Distortion distortion(problem.domain, problem.energy, problem.weights);
    VectorXd x = scaled_starts(problem.domain, starts);
    Minimum result;
    if (distortion.value(x) > near_isometry * distortion.total_area()) {
        const std::vector<ConstraintRow> none;
        Problem free{problem.domain, none, problem.energy};
        free.threads = problem.threads;
        free.contact = problem.contact;
        ConstrainedNewton approach(free, distortion, x, progress);
        approach.run(x, approach_decrease, near_isometry);
        approach.report(result);
    }
    x = moved_to_pins(problem.domain, problem.rows, x);
    ConstrainedNewton newton(problem, distortion, x, progress);
    result.converged = newton.run(x, 0.0, 0.0);
    newton.report(result);
    result.charts = problem.domain.charts(x);
    return result;
}

}  // namespace lastflat
