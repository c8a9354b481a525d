// Based on: Floater, "Parametrization and smooth approximation of surface triangulations", CAGD
// 1997; Floater, "Mean value coordinates", CAGD 2003.
#include "core/parameterize/convex_combination.h"

#include <algorithm>
#include <cmath>

#include "core/numerics/dominant_lu.h"
#include "core/numerics/polygon.h"

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
    for (std::size_t v = 0; v < rows.size(); ++v) {
        const Index row = unknown[v];
        if (row < 0) continue;
        double sum = 0.0;
        for (const auto& [neighbour, weight] : rows[v]) sum += weight;
        entries.emplace_back(row, row, 1.0);
        for (const auto& [neighbour, weight] : rows[v]) {
            const auto j = static_cast<std::size_t>(neighbour);
            if (unknown[j] >= 0) {
                entries.emplace_back(row, unknown[j], -weight / sum);
            } else {
                b.row(row) += weight / sum * fixed[j].transpose();
            }
        }
    }
    SparseMatrix A(count, count);
    A.setFromTriplets(entries.begin(), entries.end());
    const Eigen::MatrixXd x = DominantLu(A).solve(b);
    for (std::size_t v = 0; v < rows.size(); ++v) {
        if (unknown[v] >= 0) points[v] = x.row(unknown[v]).transpose();
    }
    return points;
}

std::vector<WeightedNeighbour> mean_value_weights(const Star& star) {
    const std::size_t n = star.neighbours.size();
    std::vector<double> half_tangents(n);
    // A triangle's angle is below pi; scaled or measured in a degenerate layout it might reach it.
    constexpr double largest = 3.1;
    for (std::size_t j = 0; j < n; ++j) {
        half_tangents[j] = std::tan(0.5 * std::min(star.angles[j], largest));
    }
    std::vector<WeightedNeighbour> weights;
    for (std::size_t j = 0; j < n; ++j) {
        weights.push_back({star.neighbours[j], (half_tangents[(j + n - 1) % n] + half_tangents[j]) /
                                                   star.distances[j]});
    }
    return weights;
}

Star surface_star(const Region& region, const OneRings& rings, Index vertex) {
    Star star;
    const auto ring = rings.of(vertex);
    star.neighbours.assign(ring.begin(), ring.end());
    for (std::size_t j = 0; j < ring.size(); ++j) {
        star.distances.push_back(region.distance(vertex, ring[j]));
        star.angles.push_back(angle_at(region.position(vertex), region.position(ring[j]),
                                       region.position(ring[(j + 1) % ring.size()])));
    }
    return star;
}

}  // namespace lastflat
