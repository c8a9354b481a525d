// Based on: Smith, Schaefer, "Bijective Parameterization with Free Boundaries", SIGGRAPH 2015;
// Nocedal, Wright, "Numerical Optimization", 2006, chapters 15 and 18. Unlike the first, Hessians
// are exact near the minimum whenever the system's inertia allows it.
#include "core/optimize/newton.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

constexpr int max_iterations = 300;
/// Rows that contradict each other pull with forces beyond this many times the size of the surface;
/// or their error has not fallen by a tenth within so many steps.
constexpr double greatest_force = 1e3;
constexpr int patience = 15;
/// More steps than these that promise nothing but round-off are not worth their while.
constexpr int most_idle_steps = 3;

using Eigen::VectorXd;

/// What is so at an iterate.
struct Evaluation {
    double energy = 0.0;  ///< of the distortion alone
    VectorXd gradient;    ///< of all energies
    VectorXd forces;      ///< the Lagrangian's gradient: with the rows' by their multipliers
    VectorXd values;      ///< of the rows
    double worst_error = 0.0, projected_gradient = 0.0;  ///< see `Minimum`

    /// How far the iterate is from one that satisfies the first-order conditions.
    [[nodiscard]] double distance_to_optimum() const { return projected_gradient + worst_error; }
};

struct State {
    Iterate iterate;
    Evaluation is;
};

/// The multiplier of a soft row follows from its error.
State evaluated(const Problem& problem, const ActiveSet& active, Iterate iterate) {
    Evaluation is;
    is.energy = problem.distortion.value(iterate.x);
    is.gradient = VectorXd::Zero(iterate.x.size());
    for (const EnergyTerm* term : problem.energy()) term->add_gradient(iterate.x, is.gradient);
    is.values = values_of(problem.rows, iterate.x);
    const VectorXd errors = active.residual(problem.rows, is.values);
    for (std::size_t k = 0; k < problem.rows.size(); ++k) {
        const Row& row = problem.rows[k];
        const auto i = static_cast<Eigen::Index>(k);
        if (row.is_soft())
            iterate.multipliers[i] = errors[i] / row.compliance;
        else
            is.worst_error = std::max(is.worst_error, row.relative_error(is.values[i]));
    }
    is.forces = is.gradient;
    add_forces(problem.rows, iterate.x, iterate.multipliers, is.forces);
    is.projected_gradient = is.forces.norm() / std::sqrt(problem.distortion.total_area());
    return {std::move(iterate), std::move(is)};
}

bool is_optimal(const Approach& approach, const ActiveSet& active, const Evaluation& is) {
    return !active.undecided && is.projected_gradient <= approach.projected_gradient &&
           is.worst_error <= approach.error;
}

/// The energies, and what the rows' errors cost: a soft one's what it costs indeed.
double merit(const Problem& problem, const VectorXd& x, double penalty) {
    const double energy = problem.distortion.value(x);
    if (!std::isfinite(energy)) return energy;
    double cost = 0.0;
    for (const Row& row : problem.rows) {
        const double error = row.violation(row.value(x));
        cost += row.is_soft() ? 0.5 * error * error / row.compliance : penalty * std::abs(error);
    }
    double sum = energy + cost;
    for (const EnergyTerm* term : problem.terms) sum += term->value(x);
    return sum;
}

/// Whether nothing stands in the straight way.
bool reaches(const Problem& problem, const VectorXd& x, const VectorXd& to) {
    return std::all_of(problem.terms.begin(), problem.terms.end(), [&](const EnergyTerm* term) {
        return term->largest_step(x, to - x) == 1.0;
    });
}

struct LineSearch {
    VectorXd x;            ///< where it ends
    double length = 0.0;   ///< share of the step taken; 0: the merit function does not fall
    bool blocked = false;  ///< one of the terms stood in the way of the whole step
};

/// Goes along d as far as the merit function falls, by a slope of at least `slope`.
LineSearch search(const Problem& problem, const OptimalitySystem& system, const ActiveSet& active,
                  const VectorXd& x, const VectorXd& d, double slope, double penalty) {
    constexpr double armijo = 1e-4;
    const double before = merit(problem, x, penalty);
    const double allowance = tolerance::merit_round_off * std::abs(before);
    const auto falls = [&](const VectorXd& to, double t) {
        return merit(problem, to, penalty) <= before + armijo * t * slope + allowance;
    };
    double t = problem.distortion.largest_step(x, d);
    bool blocked = false;
    for (const EnergyTerm* term : problem.terms) {
        const double free = term->largest_step(x, t * d);
        blocked = blocked || free < 1.0;
        t *= free;
    }
    for (bool first = true; t > tolerance::smallest_step; t *= 0.5, first = false) {
        VectorXd to = x + t * d;
        bool accepted = falls(to, t);
        if (!accepted && first && t == 1.0 && !problem.rows.empty()) {
            // Edges that turn by a finite angle come out too long: correct to second order.
            const VectorXd errors =
                active.exact_residual(problem.rows, values_of(problem.rows, to));
            to +=
                system.solve(VectorXd::Zero(x.size()), -errors, tolerance::refined).head(x.size());
            accepted = reaches(problem, x, to) && falls(to, t);
        }
        if (accepted) return {std::move(to), t, blocked};
    }
    return {x, 0.0, blocked};
}

/// What one step hands on to the next.
struct Momentum {
    bool near = false;     ///< the last step was a whole one: the Hessian is worth its exact self
    double penalty = 0.0;  ///< of errors, in the merit function
};

struct Step {
    State state;         ///< where it led
    VectorXd direction;  ///< the whole step that was sought
    double promised;     ///< decrease of the merit function, by the model
    double length;       ///< see `LineSearch`
    bool blocked;        ///< see `LineSearch`
};

/// One step of sequential quadratic programming.
Step take_step(const Problem& problem, OptimalitySystem& system, const ActiveSet& active,
               const State& from, Momentum& momentum, const Progress& progress) {
    const std::vector<Row>& rows = problem.rows;
    const auto& [x, multipliers] = from.iterate;
    system.factor(problem, from.iterate, active.held,
                  momentum.near ? HessianKind::exact : HessianKind::projected, progress);
    const VectorXd errors = active.residual(rows, from.is.values);
    const VectorXd solution = system.solve(-from.is.gradient, -errors, tolerance::refined);
    VectorXd d = solution.head(x.size());
    const VectorXd wanted = solution.tail(errors.size());
    double slope = from.is.gradient.dot(d), force = 0.0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const auto i = static_cast<Eigen::Index>(k);
        if (rows[k].is_soft())
            slope += multipliers[i] * (rows[k].compliance * wanted[i] - errors[i]);
        else
            force = std::max(force, std::abs(wanted[i]));
    }
    // A great force may have been a passing one.
    momentum.penalty = std::max(1.5 * force, 0.5 * momentum.penalty);
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const double value = from.is.values[static_cast<Eigen::Index>(k)];
        if (!rows[k].is_soft()) slope -= momentum.penalty * std::abs(rows[k].violation(value));
    }
    LineSearch line = search(problem, system, active, x, d, slope, momentum.penalty);
    momentum.near = line.length == 1.0;
    Iterate to{std::move(line.x), multipliers + line.length * (wanted - multipliers)};
    return {evaluated(problem, active, std::move(to)), std::move(d), -0.5 * slope, line.length,
            line.blocked};
}

/// One full step with the last factor, if it leaves less than this share of the distance to the
/// conditions. It corrects what is left of the Lagrangian's gradient, so that an old matrix does
/// not tilt the multipliers.
std::optional<State> stepped_to_conditions(const Problem& problem, const OptimalitySystem& system,
                                           const ActiveSet& active, const State& from,
                                           double much) {
    const VectorXd step =
        system.solve(-from.is.forces, -active.exact_residual(problem.rows, from.is.values),
                     tolerance::roughly_refined);
    Iterate to = from.iterate;
    to.x += step.head(to.x.size());
    to.multipliers += step.tail(to.multipliers.size());
    if (!reaches(problem, from.iterate.x, to.x)) return std::nullopt;
    State state = evaluated(problem, active, std::move(to));
    if (std::isfinite(state.is.energy) &&
        state.is.distance_to_optimum() <= much * from.is.distance_to_optimum())
        return state;
    return std::nullopt;
}

/// As many of them as do: the matrix has hardly changed (the chord method). Whether the first did.
bool reuse_factor(const Problem& problem, const Approach& approach, const OptimalitySystem& system,
                  const ActiveSet& active, double much, State& state, int& iterations) {
    bool any = false;
    while (!is_optimal(approach, active, state.is)) {
        auto next = stepped_to_conditions(problem, system, active, state, much);
        if (!next) break;
        state = std::move(*next);
        ++iterations;
        any = true;
    }
    return any;
}

/// Newton's method on the first-order conditions themselves, for as long as it brings them nearer
/// by much: no line search, and the sign of the curvature does not matter. A curve of fixed length
/// under compression whose edges are short would rather fold up like a concertina; these steps keep
/// to the smooth curve.
State solve_conditions(const Problem& problem, const Approach& approach, OptimalitySystem& system,
                       const ActiveSet& active, State state, int& iterations,
                       const Progress& progress) {
    constexpr double much = 0.1;
    (void)reuse_factor(problem, approach, system, active, much, state, iterations);
    while (!is_optimal(approach, active, state.is)) {
        progress.check();
        if (!system.factor_exact(problem, state.iterate, active.held, progress) ||
            !reuse_factor(problem, approach, system, active, much, state, iterations))
            break;
    }
    return state;
}

/// How long the errors have not fallen by much.
struct ErrorWatch {
    double least = infinity;
    int since = 0;

    /// Whether the rows seem to contradict each other after a step.
    [[nodiscard]] bool finds_contradiction(const Problem& problem, const Step& step,
                                           int iteration) {
        const double error = step.state.is.worst_error;
        if (error <= tolerance::locked_length) {
            *this = {infinity, iteration};
            return false;
        }
        if (error < 0.9 * least) *this = {error, iteration};
        if (step.blocked) since = iteration;  // that makes steps short, whatever is asked
        double force = 0.0;
        for (std::size_t k = 0; k < problem.rows.size(); ++k) {
            const double multiplier = step.state.iterate.multipliers[static_cast<Eigen::Index>(k)];
            if (!problem.rows[k].is_soft()) force = std::max(force, std::abs(multiplier));
        }
        return force > greatest_force * std::sqrt(problem.distortion.total_area()) ||
               iteration - since >= patience;
    }
};

/// The projected gradient that needles may leave, however near the minimum is.
double least_gradient(const Problem& problem, const OptimalitySystem& system) {
    constexpr double arithmetic = 10.0;  // what sums and rows add; measured: 0.04 to 3
    const double rounding = arithmetic * system.gradient_round_off();
    return std::max(tolerance::stalled_gradient,
                    rounding / std::sqrt(problem.distortion.total_area()));
}

/// The rows' error that the rounding of coordinates may leave where edges are tiny.
double least_error(const Problem& problem, const VectorXd& x) {
    double reference = infinity;
    for (const Row& row : problem.rows) {
        if (!row.is_soft()) reference = std::min(reference, row.reference);
    }
    const double rounding =
        2.0 * std::numeric_limits<double>::epsilon() * x.lpNorm<Eigen::Infinity>();
    return std::clamp(rounding / reference, tolerance::solver_length, tolerance::locked_length);
}

/// Whether a step promised nothing but round-off where needles stop the gradient's fall.
bool is_idle(const Problem& problem, const OptimalitySystem& system, const ActiveSet& active,
             const Step& step) {
    const Evaluation& is = step.state.is;
    return step.promised <= tolerance::idle_decrease * is.energy && !active.undecided &&
           is.projected_gradient <= least_gradient(problem, system) &&
           is.worst_error <= least_error(problem, step.state.iterate.x);
}

/// Whether borders that slide along each other keep the steps short, and little comes of it.
struct SlideWatch {
    double energy = infinity;  ///< at the beginning of a round of steps
    int steps = 0, blocked = 0;

    [[nodiscard]] bool finds_no_gain(const Step& step) {
        constexpr int round = 50;
        constexpr double gain = 1e-3;
        blocked += step.blocked ? 1 : 0;
        if (++steps < round) return false;
        const bool gained = step.state.is.energy < (1.0 - gain) * energy;
        const bool slid = 2 * blocked > steps;
        *this = {step.state.is.energy, 0, 0};
        return slid && !gained && step.state.is.worst_error <= tolerance::locked_length;
    }
};

enum class End { converged, contradictory, given_up };

/// Steps until the end, where it leaves the state.
End run(const Problem& problem, const Approach& approach, OptimalitySystem& system, State& state,
        int& iterations, const Progress& progress) {
    const std::vector<Row>& rows = problem.rows;
    const double area = problem.distortion.total_area();
    ActiveSet active(rows, values_of(rows, state.iterate.x), state.iterate.multipliers);
    state = evaluated(problem, active, std::move(state.iterate));
    constexpr double worth_a_solve = 0.4;  // a new factor costs as much as several of them
    if (system.is_factored_with(active.held))
        (void)reuse_factor(problem, approach, system, active, worth_a_solve, state, iterations);
    Momentum momentum{state.is.energy < near_isometry * area};
    ErrorWatch watch;
    SlideWatch slide;
    int idle_steps = 0;
    while (iterations < max_iterations) {
        if (state.is.energy < approach.enough * area) return End::converged;
        if (active.update(rows, state.is.values, state.iterate.multipliers))
            state = evaluated(problem, active, std::move(state.iterate));
        if (is_optimal(approach, active, state.is)) return End::converged;
        progress.check();
        ++iterations;
        Step step = take_step(problem, system, active, state, momentum, progress);
        idle_steps = is_idle(problem, system, active, step) ? idle_steps + 1 : 0;
        const bool contradicts = watch.finds_contradiction(problem, step, iterations);
        const bool slides = slide.finds_no_gain(step);
        state = std::move(step.state);
        if (idle_steps > most_idle_steps) return End::converged;
        if (approach.decrease > 0.0 && step.promised < approach.decrease * state.is.energy)
            return End::converged;
        if (contradicts) return End::contradictory;
        if (slides) return End::given_up;
        if (step.length == 1.0 && state.is.distance_to_optimum() <= tolerance::nearly_optimal)
            state = solve_conditions(problem, approach, system, active, std::move(state),
                                     iterations, progress);
        if (step.length > 0.0) continue;
        // No part of the step could be taken: rows that it would have broken may be what it lacks.
        if (active.hold_violated(rows, values_of(rows, state.iterate.x + step.direction))) continue;
        const double least = step.promised <= tolerance::idle_decrease * state.is.energy
                                 ? least_gradient(problem, system)
                                 : tolerance::stalled_gradient;
        return state.is.projected_gradient <= least ? End::converged : End::given_up;
    }
    return End::given_up;
}

}  // namespace

Minimum minimise(const Problem& problem, const Iterate& start, const Approach& approach,
                 OptimalitySystem& system, const Progress& progress) {
    const auto count = static_cast<Eigen::Index>(problem.rows.size());
    State state{start, {}};
    int iterations = 0;
    const End end = run(problem, approach, system, state, iterations, progress);
    Minimum minimum;
    minimum.charts = problem.domain.charts(state.iterate.x);
    minimum.multipliers = std::move(state.iterate.multipliers);
    minimum.iterations = iterations;
    minimum.energy = state.is.energy / problem.distortion.total_area();
    minimum.projected_gradient = state.is.projected_gradient;
    minimum.worst_error = state.is.worst_error;
    minimum.converged = end == End::converged;
    minimum.contradictory = end == End::contradictory;
    minimum.errors = VectorXd(count);
    for (Eigen::Index k = 0; k < count; ++k)
        minimum.errors[k] = problem.rows[static_cast<std::size_t>(k)].violation(state.is.values[k]);
    return minimum;
}

}  // namespace lastflat
