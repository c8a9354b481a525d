// Based on: Floater, "Parametrization and smooth approximation of surface triangulations", CAGD
// 1997.
#include "core/parameterize/convex_combination.h"

#include "core/numerics/dominant_lu.h"

namespace lastflat {

Points2 solve_convex_combinations(const WeightRows& rows, const Points2& fixed) {
    std::vector<Index> unknown(rows.size(), -1);
    Index count = 0;
    std::size_t entries_count = 0;
    for (std::size_t v = 0; v < rows.size(); ++v) {
        if (rows[v].empty()) continue;
        unknown[v] = count++;
        entries_count += rows[v].size() + 1;
    }
    Points2 points = fixed;
    if (count == 0) return points;
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(entries_count);
    Eigen::MatrixXd b = Eigen::MatrixXd::Zero(count, 2);
    bool dominant = true;
    for (std::size_t v = 0; v < rows.size(); ++v) {
        const Index row = unknown[v];
        if (row < 0) continue;
        double sum = 0.0;
        for (const auto& [neighbour, weight] : rows[v]) {
            const auto j = static_cast<std::size_t>(neighbour);
            sum += weight;
            dominant = dominant && weight >= 0.0;
            if (unknown[j] >= 0) {
                entries.emplace_back(row, unknown[j], -weight);
            } else {
                b.row(row) += weight * fixed[j].transpose();
            }
        }
        entries.emplace_back(row, row, sum);
    }
    SparseMatrix A(count, count);
    A.setFromTriplets(entries.begin(), entries.end());
    const DominantLu factor(A);
    Eigen::MatrixXd x = factor.solve(b);
    // Negative weights take the guarantee of small pivots' absence away: refine what they cost.
    for (int refinement = 0; refinement < (dominant ? 0 : 2); ++refinement) {
        x += factor.solve(b - A * x);
    }
    for (std::size_t v = 0; v < rows.size(); ++v) {
        if (unknown[v] >= 0) points[v] = x.row(unknown[v]).transpose();
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
