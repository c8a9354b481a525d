// Based on: Floater, "Parametrization and smooth approximation of surface triangulations", CAGD
// 1997.
#include "core/parameterize/convex_combination.h"

#include <algorithm>

#include "core/numerics/multifrontal_lu.h"

namespace lastflat {

namespace {

/// A x = b for the unknown vertices: row by row the sum of the weights on the diagonal, minus the
/// weights beside it; what is fixed stands on the right.
struct MeanSystem {
    Eigen::SparseMatrix<double, Eigen::RowMajor> A;
    Eigen::MatrixXd b;
    bool dominant = true;  ///< no weight is negative
};

MeanSystem mean_system(const WeightRows& rows, const Points2& fixed,
                       const std::vector<Index>& unknown) {
    const auto row_of = inverse(unknown, rows.size());
    const auto count = static_cast<Index>(unknown.size());
    MeanSystem system{{count, count}, Eigen::MatrixXd::Zero(count, 2)};
    std::size_t entries = 0;
    for (const auto& row : rows) entries += row.size() + 1;
    system.A.reserve(static_cast<Eigen::Index>(entries));
    std::vector<std::pair<Index, double>> line;
    for (Index row = 0; row < count; ++row) {
        const auto v = static_cast<std::size_t>(unknown[static_cast<std::size_t>(row)]);
        line.clear();
        double sum = 0.0;
        for (const auto& [neighbour, weight] : rows[v]) {
            const auto j = static_cast<std::size_t>(neighbour);
            sum += weight;
            system.dominant = system.dominant && weight >= 0.0;
            if (row_of[j] >= 0) {
                line.emplace_back(row_of[j], -weight);
            } else {
                system.b.row(row) += weight * fixed[j].transpose();
            }
        }
        line.emplace_back(row, sum);
        std::sort(line.begin(), line.end());
        system.A.startVec(row);
        for (const auto& [column, value] : line) {
            system.A.insertBackByOuterInner(row, column) = value;
        }
    }
    system.A.finalize();
    return system;
}

}  // namespace

Points2 solve_convex_combinations(const WeightRows& rows, const Points2& fixed,
                                  const Dissection& dissection) {
    const Elimination elimination =
        elimination_of(dissection, [&](Index v) { return !rows[at(v)].empty(); });
    const std::vector<Index>& unknown = elimination.vertices;
    Points2 points = fixed;
    if (unknown.empty()) return points;
    const MeanSystem system = mean_system(rows, fixed, unknown);
    const MultifrontalLu factor(SparseMatrix(system.A), elimination.blocks);
    Eigen::MatrixXd x = factor.solve(system.b);
    // Negative weights take the guarantee against small pivots away: refine what they cost.
    for (int refinement = 0; refinement < (system.dominant ? 0 : 2); ++refinement) {
        x += factor.solve(system.b - system.A * x);
    }
    for (std::size_t k = 0; k < unknown.size(); ++k) {
        points[static_cast<std::size_t>(unknown[k])] =
            x.row(static_cast<Eigen::Index>(k)).transpose();
    }
    return points;
}

std::vector<WeightedNeighbour> weighted_neighbours(const Star& star, WeightRule weights) {
    const auto values = weights(star);
    std::vector<WeightedNeighbour> row;
    row.reserve(values.size());
    for (std::size_t j = 0; j < values.size(); ++j) row.push_back({star.neighbours[j], values[j]});
    return row;
}

}  // namespace lastflat
