#include "core/constrain/resolve_conflicts.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

/// mm of error for a force of 1 mm while constraints compromise: so little that the distortion
/// hardly counts beside it.
constexpr double compromise = 1e-6;

std::string amount(double value, const char* unit) {
    char text[48];
    std::snprintf(text, sizeof text, "%.3g%s", value, unit);
    return text;
}

class Resolver {
public:
    Resolver(const Domain& domain, const std::vector<Chart>& starts,
             const std::vector<Constraint>& constraints, const IsotropicEnergy& energy,
             std::size_t threads, const Progress& progress)
        : domain_(domain),
          starts_(starts),
          constraints_(constraints),
          energy_(energy),
          threads_(threads),
          progress_(progress),
          rows_(constraint_rows(domain, constraints)),
          role_(constraints.size(), Role::kept) {}

    ConstrainedChart run(OnConflict on_conflict) {
        ConstrainedChart result;
        result.minimum = solve(role_);
        while (!kept(result.minimum)) {
            const auto fighting = smallest_conflict();
            if (on_conflict == OnConflict::fail) fail(fighting);
            result.relaxed.push_back(yield(fighting));
            result.minimum = solve(role_);
        }
        return result;
    }

private:
    enum class Role { kept, soft, absent };

    [[nodiscard]] Minimum solve(const std::vector<Role>& roles) const {
        std::vector<ConstraintRow> rows;
        std::vector<double> compliance;
        for (const ConstraintRow& row : rows_) {
            const Role role = roles[row.constraint];
            if (role == Role::absent) continue;
            rows.push_back(row);
            compliance.push_back(role == Role::soft ? compromise : 0.0);
        }
        return minimise_distortion({domain_, rows, energy_, compliance, threads_}, starts_,
                                   progress_);
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
        std::vector<Role> roles = role_;
        for (auto& role : roles) {
            if (role == Role::soft) role = Role::absent;
        }
        std::vector<std::size_t> fighting;
        for (const std::size_t c : order) {
            roles[c] = Role::absent;
            if (!kept(solve(roles))) continue;
            roles[c] = Role::kept;
            fighting.push_back(c);
        }
        return fighting;
    }

    /// The least important of them becomes soft.
    std::size_t yield(const std::vector<std::size_t>& fighting) {
        role_[fighting.front()] = Role::soft;
        return fighting.front();
    }

    [[noreturn]] void fail(const std::vector<std::size_t>& fighting) const {
        std::vector<Role> roles(constraints_.size(), Role::absent);
        for (const std::size_t c : fighting) roles[c] = Role::soft;
        const Minimum best = solve(roles);
        std::string text;
        std::optional<Vec3> first_place;
        for (const std::size_t c : fighting) {
            double worst = 0.0;
            Index vertex = -1;
            Eigen::Index k = 0;
            for (const ConstraintRow& row : rows_) {
                if (roles[row.constraint] == Role::absent) continue;
                const double error = best.errors[k++];
                if (row.constraint != c || std::abs(error) <= std::abs(worst)) continue;
                worst = error;
                vertex = row.vertex;
            }
            text +=
                (text.empty() ? "" : ", ") + constraints_[c].title() + " (" + amount(worst, " mm");
            if (vertex >= 0) {
                text += " at " + place(domain_.position(vertex));
                if (!first_place) first_place = domain_.position(vertex);
            }
            text += ")";
        }
        Error error(ErrorCode::constraints_infeasible,
                    "region '" + domain_.regions.front()->name +
                        "': these constraints cannot all hold; at the best compromise they are off "
                        "by: " +
                        text + "; leave one out or let it give way (\"on_conflict\": \"relax\")");
        if (first_place) error.at_position(*first_place);
        if (!fighting.empty()) error.at_option(constraints_[fighting.front()].option);
        throw error;
    }

    const Domain& domain_;
    const std::vector<Chart>& starts_;
    const std::vector<Constraint>& constraints_;
    const IsotropicEnergy& energy_;
    std::size_t threads_;
    const Progress& progress_;
    const std::vector<ConstraintRow> rows_;
    std::vector<Role> role_;
};

Warning not_converged(const Domain& domain, const Minimum& minimum) {
    return {"not_converged",
            "region '" + domain.regions.front()->name + "' is sound but not at its minimum after " +
                std::to_string(minimum.iterations) + " Newton steps: its projected gradient is " +
                amount(minimum.projected_gradient, ""),
            std::nullopt};
}

}  // namespace

ConstrainedChart least_distortion(const Domain& domain, const std::vector<Chart>& starts,
                                  const std::vector<Constraint>& constraints,
                                  const IsotropicEnergy& energy, OnConflict on_conflict,
                                  std::size_t threads, const Progress& progress) {
    ConstrainedChart result =
        Resolver(domain, starts, constraints, energy, threads, progress).run(on_conflict);
    if (!result.minimum.converged) result.warnings.push_back(not_converged(domain, result.minimum));
    return result;
}

}  // namespace lastflat
