#include "core/constrain/resolve_conflicts.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/constrain/closure.h"
#include "core/numerics/tolerances.h"
#include "core/optimize/border_contact.h"

namespace lastflat {
namespace {

/// mm of error for a force of 1 mm while constraints compromise: so little that the distortion
/// hardly counts beside it.
constexpr double compromise = 1e-4;
/// A constraint that gave way still pulls, but at most with this share of the size of the surface.
constexpr double greatest_pull = 0.1;

std::string amount(double value, const char* unit) {
    char text[48];
    std::snprintf(text, sizeof text, "%.3g%s", value, unit);
    return text;
}

/// A search for the smallest set that fights ends after so many Newton steps; what it has not
/// looked at then counts as fighting.
constexpr int most_steps = 2000;

/// "region 'lateral'", "regions 'lateral' and 'medial'": for people.
std::string names_of(const Domain& domain) {
    std::string text = domain.regions.size() > 1 ? "regions " : "region ";
    for (std::size_t r = 0; r < domain.regions.size(); ++r) {
        if (r > 0) text += " and ";
        text += "'" + domain.regions[r]->name + "'";
    }
    return text;
}

double total_area(const Domain& domain) {
    double area = 0.0;
    for (const Region* region : domain.regions) area += surface_area(*region);
    return area;
}

class Resolver {
public:
    Resolver(const Domain& domain, const std::vector<Chart>& starts, const Demands& demands,
             std::size_t threads, const Progress& progress, Warmth* left)
        : domain_(domain),
          starts_(starts),
          demands_(demands),
          constraints_(demands.constraints),
          progress_(progress),
          left_(left),
          rows_(constraint_rows(domain, constraints_)),
          distortion_(domain, demands.energy, demands.weights),
          wires_(domain, locked_wires(domain, constraints_)),
          approach_{domain, distortion_, {}, {}, threads},
          role_(constraints_.size(), Role::kept),
          compliance_(rows_.size(), compromise) {
        if (demands.contact) approach_.terms.push_back(&contact_.emplace(domain));
    }

    ConstrainedChart run() {
        ConstrainedChart result;
        const auto relax = [&](std::size_t constraint) {
            role_[constraint] = Role::soft;
            result.relaxed.push_back(constraint);
        };
        while (const auto loop = open_loop(domain_, kept_rows(), constraints_)) {
            progress_.check();
            if (demands_.on_conflict == OnConflict::fail) fail(*loop);
            relax(least_important(loop->constraints));
        }
        result.minimum = solve(without_soft());
        while (!kept(result.minimum)) {
            if (!result.minimum.contradictory) give_up(result.minimum);
            const auto fighting = smallest_conflict();
            if (fighting.size() == 1) give_up(result.minimum);  // alone, each of them can hold
            if (demands_.on_conflict == OnConflict::fail) fail(fighting);
            relax(fighting.front());
            result.minimum = solve(without_soft());
        }
        if (!result.relaxed.empty()) pull_back(result.minimum);
        if (left_ != nullptr && !(result.relaxed.empty() && result.minimum.converged)) *left_ = {};
        return result;
    }

    std::optional<ConstrainedChart> run_again() {
        if (open_loop(domain_, kept_rows(), constraints_)) return std::nullopt;
        const Problem problem = problem_of(role_);
        Iterate iterate{left_->iterate.x, carried_multipliers(*left_, problem.rows)};
        OptimalitySystem other;
        OptimalitySystem& system = are_alike(left_->rows, problem.rows) ? left_->system : other;
        ConstrainedChart result{
            minimise_distortion_again(problem, iterate, system, progress_), {}, {}};
        if (!kept(result.minimum) || !result.minimum.converged) return std::nullopt;
        left_->rows = problem.rows;
        left_->iterate = {domain_.coordinates(result.minimum.charts), result.minimum.multipliers};
        if (&system == &other) {  // of another pattern
            left_->system = std::move(other);
            left_->spare = {};
        }
        return result;
    }

    void refresh() {
        const Problem problem = problem_of(role_);
        if (!are_alike(left_->rows, problem.rows)) return;
        Iterate& iterate = left_->iterate;
        const ActiveSet active(problem.rows, values_of(problem.rows, iterate.x),
                               iterate.multipliers);
        if (left_->spare.factor_exact(problem, iterate, active.held, progress_))
            std::swap(left_->system, left_->spare);
    }

private:
    enum class Role { kept, soft, absent };

    /// Where the constraints are out of reach from the start, a compromise comes first: from there
    /// they may be near.
    [[nodiscard]] Minimum solve(const std::vector<Role>& roles) const {
        Minimum minimum = solve_from(starts_, roles);
        if (kept(minimum)) return minimum;
        std::vector<Role> yielding = roles;
        for (Role& role : yielding) {
            if (role == Role::kept) role = Role::soft;
        }
        return solve_from(solve_from(starts_, yielding).charts, roles);
    }

    [[nodiscard]] Minimum solve_from(const std::vector<Chart>& starts,
                                     const std::vector<Role>& roles) const {
        const Problem problem = problem_of(roles);
        OptimalitySystem system;
        Minimum minimum = minimise_distortion(approach_, problem, starts, system, progress_);
        steps_ += minimum.iterations;
        if (left_ != nullptr)
            *left_ = {problem.rows,
                      {domain_.coordinates(minimum.charts), minimum.multipliers},
                      std::move(system)};
        return minimum;
    }

    [[nodiscard]] Problem problem_of(const std::vector<Role>& roles) const {
        Problem problem = approach_;
        problem.terms.push_back(&wires_);
        for (const std::size_t k : chosen_rows(roles)) {
            problem.rows.push_back(rows_[k]);
            if (roles[rows_[k].constraint] == Role::soft)
                problem.rows.back().compliance = compliance_[k];
        }
        return problem;
    }

    /// What the roles leave to be solved: exact rows without repeats, and the soft ones.
    [[nodiscard]] std::vector<std::size_t> chosen_rows(const std::vector<Role>& roles) const {
        std::vector<std::size_t> exact, chosen;
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            if (roles[rows_[k].constraint] == Role::kept) exact.push_back(k);
            if (roles[rows_[k].constraint] == Role::soft) chosen.push_back(k);
        }
        for (const std::size_t k : distinct_rows(rows_, exact)) chosen.push_back(k);
        std::sort(chosen.begin(), chosen.end());
        return chosen;
    }

    [[nodiscard]] static bool kept(const Minimum& minimum) {
        return minimum.worst_error <= tolerance::locked_length;
    }

    /// Leaves out one constraint after the other, the least important first; what can stay out
    /// while the rest still fights does not belong to the conflict (the deletion filter).
    [[nodiscard]] std::vector<std::size_t> smallest_conflict() const {
        std::vector<std::size_t> order;
        for (std::size_t c = 0; c < constraints_.size(); ++c) {
            const bool present =
                std::any_of(rows_.begin(), rows_.end(),
                            [&](const ConstraintRow& row) { return row.constraint == c; });
            if (present && role_[c] == Role::kept) order.push_back(c);
        }
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return constraints_[a].priority < constraints_[b].priority;
        });
        std::vector<Role> roles = without_soft();
        std::vector<std::size_t> fighting;
        for (const std::size_t c : order) {
            roles[c] = Role::absent;
            if (steps_ < most_steps && !kept(solve(roles))) continue;
            roles[c] = Role::kept;
            fighting.push_back(c);
        }
        return fighting;
    }

    [[nodiscard]] std::vector<Role> without_soft() const {
        std::vector<Role> roles = role_;
        for (Role& role : roles) {
            if (role == Role::soft) role = Role::absent;
        }
        return roles;
    }

    /// Lets the constraints that gave way pull the charts back, as far as the others give.
    void pull_back(Minimum& minimum) {
        const Eigen::VectorXd x = domain_.coordinates(minimum.charts);
        const double force = greatest_pull * std::sqrt(total_area(domain_));
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            const double error = std::abs(rows_[k].violation(rows_[k].value(x)));
            compliance_[k] = std::max(compromise, error / force);
        }
        Minimum pulled = solve_from(minimum.charts, role_);
        if (kept(pulled) && pulled.converged) minimum = std::move(pulled);
    }

    [[nodiscard]] std::vector<ConstraintRow> kept_rows() const {
        std::vector<ConstraintRow> rows;
        for (const std::size_t k : chosen_rows(without_soft())) rows.push_back(rows_[k]);
        return rows;
    }

    [[nodiscard]] std::size_t least_important(const std::vector<std::size_t>& fighting) const {
        return *std::min_element(fighting.begin(), fighting.end(),
                                 [&](std::size_t a, std::size_t b) {
                                     return constraints_[a].priority < constraints_[b].priority;
                                 });
    }

    [[noreturn]] void give_up(const Minimum& minimum) const {
        throw Error(ErrorCode::method_failed,
                    names_of(domain_) + ": the constraints were not reached in " +
                        std::to_string(minimum.iterations) +
                        " steps, which does not mean that they cannot hold: the largest error is " +
                        amount(minimum.worst_error, "") +
                        " of its length; cut the region so that it opens wider, or ask for less")
            .at_option({"constraints"});
    }

    [[noreturn]] void fail(const OpenLoop& loop) const {
        std::vector<ConflictMember> members;
        std::string names;
        for (const std::size_t c : loop.constraints) {
            members.push_back(
                {constraints_[c].option, title(constraints_[c]), loop.gap_mm, loop.position});
            names += (names.empty() ? "" : ", ") + title(constraints_[c]);
        }
        throw Error(ErrorCode::constraints_infeasible,
                    names_of(domain_) + ": " + names + " cannot all hold: " + loop.why)
            .at_option(constraints_[loop.constraints.front()].option)
            .at_position(loop.position)
            .with_conflict(std::move(members));
    }

    [[noreturn]] void fail(const std::vector<std::size_t>& fighting) const {
        std::vector<Role> roles(constraints_.size(), Role::absent);
        for (const std::size_t c : fighting) roles[c] = Role::soft;
        const Minimum best = solve(roles);
        std::vector<ConflictMember> members(fighting.size());
        std::transform(fighting.begin(), fighting.end(), members.begin(),
                       [&](std::size_t c) { return member(c, roles, best); });
        std::string text;
        for (const ConflictMember& m : members) {
            text += (text.empty() ? "" : ", ") + m.title + " (" + amount(m.off_mm, " mm") + " at " +
                    position_text(m.position) + ")";
        }
        const Vec3 first = members.front().position;
        throw Error(ErrorCode::constraints_infeasible,
                    names_of(domain_) +
                        ": these constraints cannot all hold; at the best compromise they are off "
                        "by: " +
                        text)
            .at_option(constraints_[fighting.front()].option)
            .at_position(first)
            .with_conflict(std::move(members));
    }

    /// How far a constraint is off at the best compromise, and where most.
    [[nodiscard]] ConflictMember member(std::size_t c, const std::vector<Role>& roles,
                                        const Minimum& best) const {
        ConflictMember result{constraints_[c].option, title(constraints_[c]), 0.0, Vec3::Zero()};
        Eigen::Index i = 0;
        double worst = -1.0;
        for (const std::size_t k : chosen_rows(roles)) {
            const ConstraintRow& row = rows_[k];
            const double error = best.errors[i++];
            if (row.constraint != c || std::abs(error) <= worst) continue;
            worst = std::abs(error);
            result.off_mm = error;
            result.position = domain_.position(row.vertex);
        }
        return result;
    }

    const Domain& domain_;
    const std::vector<Chart>& starts_;
    const Demands& demands_;
    const std::vector<Constraint>& constraints_;
    const Progress& progress_;
    Warmth* const left_;  ///< for the next solve; null: nobody wants it
    const std::vector<ConstraintRow> rows_;
    const Distortion distortion_;
    const WireStiffness wires_;
    std::optional<BorderContact> contact_;
    Problem approach_;       ///< without rows and wires
    mutable int steps_ = 0;  ///< of all solves
    std::vector<Role> role_;
    std::vector<double> compliance_;  ///< per row, while it is soft
};

Warning not_converged(const Domain& domain, const Minimum& minimum) {
    return {"not_converged",
            names_of(domain) + ": sound, but not at the minimum after " +
                std::to_string(minimum.iterations) + " Newton steps: its projected gradient is " +
                amount(minimum.projected_gradient, ""),
            std::nullopt};
}

}  // namespace

ConstrainedChart least_distortion(const Domain& domain, const std::vector<Chart>& starts,
                                  const Demands& demands, std::size_t threads,
                                  const Progress& progress, Warmth* left) {
    ConstrainedChart result = Resolver(domain, starts, demands, threads, progress, left).run();
    if (!result.minimum.converged) result.warnings.push_back(not_converged(domain, result.minimum));
    return result;
}

std::optional<ConstrainedChart> least_distortion_again(const Domain& domain, const Demands& demands,
                                                       std::size_t threads,
                                                       const Progress& progress, Warmth& warmth) {
    if (warmth.is_empty()) return std::nullopt;
    const std::vector<Chart> no_starts;
    return Resolver(domain, no_starts, demands, threads, progress, &warmth).run_again();
}

void refresh(const Domain& domain, const Demands& demands, std::size_t threads,
             const Progress& progress, Warmth& warmth) {
    if (warmth.is_empty()) return;
    const std::vector<Chart> no_starts;
    Resolver(domain, no_starts, demands, threads, progress, &warmth).refresh();
}

}  // namespace lastflat
