// Based on: Hintermueller, Ito, Kunisch, "The Primal-Dual Active Set Strategy as a Semismooth
// Newton Method", SIAM J. Optimization 2002.
#include "core/optimize/active_set.h"

#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

/// An inequality that was let go so often stays: it would come and go forever.
constexpr int most_releases = 8;

/// The bound that a row breaks at this value, beyond what the solver aims at.
Held broken_bound(const Row& row, double value) {
    const double error = row.violation(value);
    if (std::abs(error) <= tolerance::solver_length * row.reference) return Held::not_held;
    return error > 0.0 ? Held::by_most : Held::by_least;
}

}  // namespace

ActiveSet::ActiveSet(const std::vector<Row>& rows, const Eigen::VectorXd& values,
                     Eigen::VectorXd& multipliers)
    : releases(rows.size(), 0) {
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const Row& row = rows[k];
        const auto i = static_cast<Eigen::Index>(k);
        const double near = tolerance::locked_length * row.reference;
        Held now = Held::not_held;
        if (row.is_equation() || (multipliers[i] > 0.0 && values[i] >= row.most - near))
            now = Held::by_most;
        else if (multipliers[i] < 0.0 && values[i] <= row.least + near)
            now = Held::by_least;
        if (now == Held::not_held) multipliers[i] = 0.0;
        held.push_back(now);
    }
}

bool ActiveSet::update(const std::vector<Row>& rows, const Eigen::VectorXd& values,
                       Eigen::VectorXd& multipliers) {
    bool changed = false;
    undecided = false;
    for (std::size_t k = 0; k < rows.size(); ++k) {
        if (rows[k].is_equation()) continue;
        const auto i = static_cast<Eigen::Index>(k);
        const Held before = held[k];
        const bool pulls_in = static_cast<double>(before) * multipliers[i] < 0.0;
        undecided = undecided || (pulls_in && releases[k] >= most_releases);
        if (pulls_in && releases[k] < most_releases) {
            held[k] = Held::not_held;
            multipliers[i] = 0.0;
            ++releases[k];
        } else if (const Held broken = broken_bound(rows[k], values[i]); broken != Held::not_held) {
            held[k] = broken;
        }
        changed = changed || held[k] != before;
    }
    return changed;
}

bool ActiveSet::hold_violated(const std::vector<Row>& rows, const Eigen::VectorXd& values) {
    bool found = false;
    for (std::size_t k = 0; k < rows.size(); ++k) {
        if (held[k] != Held::not_held || releases[k] >= most_releases) continue;
        held[k] = broken_bound(rows[k], values[static_cast<Eigen::Index>(k)]);
        found = found || held[k] != Held::not_held;
    }
    return found;
}

Eigen::VectorXd ActiveSet::residual(const std::vector<Row>& rows,
                                    const Eigen::VectorXd& values) const {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(values.size());
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const auto i = static_cast<Eigen::Index>(k);
        if (held[k] == Held::by_most) result[i] = values[i] - rows[k].most;
        if (held[k] == Held::by_least) result[i] = values[i] - rows[k].least;
    }
    return result;
}

Eigen::VectorXd ActiveSet::exact_residual(const std::vector<Row>& rows,
                                          const Eigen::VectorXd& values) const {
    Eigen::VectorXd errors = residual(rows, values);
    for (std::size_t k = 0; k < rows.size(); ++k) {
        if (rows[k].is_soft()) errors[static_cast<Eigen::Index>(k)] = 0.0;
    }
    return errors;
}

}  // namespace lastflat
