#include "core/optimize/row.h"

#include <algorithm>

namespace lastflat {

std::vector<Index> Row::vertices() const {
    std::vector<Index> result;
    for (const RowTerm& term : terms) {
        std::visit(
            [&](const auto& of) {
                for (const Index v : of.vertices()) result.push_back(v);
            },
            term.of);
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
}

double Row::value(const Eigen::VectorXd& x) const {
    const Vec2 o = origin(x);
    double sum = 0.0;
    for (const RowTerm& term : terms)
        sum += term.factor * std::visit([&](const auto& of) { return of.value(x, o); }, term.of);
    return sum;
}

void Row::for_hessian(const Eigen::VectorXd& x, double multiplier, HessianKind kind,
                      const TakeBlock& take) const {
    for (const RowTerm& term : terms) {
        std::visit([&](const auto& of) { of.for_hessian(x, multiplier * term.factor, kind, take); },
                   term.of);
    }
}

Eigen::VectorXd values_of(const std::vector<Row>& rows, const Eigen::VectorXd& x) {
    Eigen::VectorXd values(static_cast<Eigen::Index>(rows.size()));
    std::transform(rows.begin(), rows.end(), values.begin(),
                   [&](const Row& row) { return row.value(x); });
    return values;
}

void add_forces(const std::vector<Row>& rows, const Eigen::VectorXd& x,
                const Eigen::VectorXd& multipliers, Eigen::VectorXd& gradient) {
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const double multiplier = multipliers[static_cast<Eigen::Index>(k)];
        rows[k].for_gradient(x, [&](Index vertex, double factor, const Vec2& of) {
            gradient.segment<2>(2 * vertex) += multiplier * factor * of;
        });
    }
}

}  // namespace lastflat
