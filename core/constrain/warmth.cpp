#include "core/constrain/warmth.h"

#include <algorithm>
#include <map>

namespace lastflat {
namespace {

/// What a row is about, in an order.
std::vector<Index> key_of(const Row& row) {
    std::vector<Index> key;
    for (const RowTerm& term : row.terms) {
        key.push_back(static_cast<Index>(term.of.index()));
        key.push_back(term.factor < 0.0 ? -1 : 1);
        std::visit(
            [&](const auto& of) {
                for (const Index v : of.vertices()) key.push_back(v);
            },
            term.of);
        if (const auto* held = std::get_if<Coordinate>(&term.of)) key.push_back(held->axis);
    }
    return key;
}

}  // namespace

bool are_alike(const std::vector<Row>& a, const std::vector<Row>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Row& one, const Row& other) {
        return one.terms == other.terms && one.is_soft() == other.is_soft() &&
               one.is_equation() == other.is_equation();
    });
}

Eigen::VectorXd carried_multipliers(const Warmth& warmth, const std::vector<Row>& rows) {
    if (are_alike(warmth.rows, rows)) return warmth.iterate.multipliers;
    std::map<std::vector<Index>, double> known;
    for (std::size_t k = 0; k < warmth.rows.size(); ++k)
        known[key_of(warmth.rows[k])] = warmth.iterate.multipliers[static_cast<Eigen::Index>(k)];
    Eigen::VectorXd multipliers = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(rows.size()));
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const auto found = known.find(key_of(rows[k]));
        if (found != known.end()) multipliers[static_cast<Eigen::Index>(k)] = found->second;
    }
    return multipliers;
}

}  // namespace lastflat
