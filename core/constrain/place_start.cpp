#include "core/constrain/place_start.h"

#include <cmath>

#include "core/constrain/pins.h"
#include "core/error.h"

namespace lastflat {

Eigen::VectorXd scaled_starts(const Domain& domain, const std::vector<Chart>& starts) {
    Eigen::VectorXd x = domain.coordinates(starts);
    for (std::size_t r = 0; r < domain.regions.size(); ++r) {
        const Region& region = *domain.regions[r];
        const auto flipped = flipped_triangles(region, starts[r].uv);
        if (!flipped.empty()) {
            throw Error(ErrorCode::method_failed,
                        std::to_string(flipped.size()) + " triangles of the start are flipped");
        }
        const double scale = std::sqrt(surface_area(region) / flat_area(region, starts[r].uv));
        x.segment(2 * domain.first[r], 2 * (domain.first[r + 1] - domain.first[r])) *= scale;
    }
    return x;
}

Eigen::VectorXd moved_to_pins(const Domain& domain, const std::vector<ConstraintRow>& rows,
                              const Eigen::VectorXd& x) {
    std::vector<Chart> charts = domain.charts(x);
    for (std::size_t r = 0; r < charts.size(); ++r) {
        const Index first = domain.first[r], end = domain.first[r + 1];
        std::vector<PinnedVertex> pins;
        for (const ConstraintRow& row : rows) {
            const Term& term = row.terms.front();
            if (term.kind != TermKind::coordinate || term.a < first || term.a >= end) continue;
            if (term.b == 0) pins.push_back({term.a - first, Vec2(row.most, 0.0)});
            if (term.b == 1) pins.back().place.y() = row.most;
        }
        move_to_pins(pins, charts[r].uv);
    }
    return domain.coordinates(charts);
}

}  // namespace lastflat
