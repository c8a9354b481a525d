#include "core/parameterize/fixed_border.h"

#include "core/parameterize/convex_combination.h"

namespace lastflat {

Chart flatten_fixed_border(const Region& region, WeightRule weights, const Points2& border) {
    WeightRows rows(region.positions.size());
    for (std::size_t v = 0; v < rows.size(); ++v) {
        const auto vertex = static_cast<Index>(v);
        if (!region.half_edges.on_border(vertex)) {
            rows[v] = weighted_neighbours(surface_star(region, vertex), weights);
        }
    }
    Points2 fixed(region.positions.size(), Vec2::Zero());
    for (std::size_t i = 0; i < border.size(); ++i) {
        fixed[static_cast<std::size_t>(region.border[i])] = border[i];
    }
    return {
        solve_convex_combinations(rows, fixed, dissection_of(region.positions, region.half_edges))};
}

}  // namespace lastflat
