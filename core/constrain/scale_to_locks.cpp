#include "core/constrain/scale_to_locks.h"

#include <cmath>

namespace lastflat {

Chart scaled_to_locks(const Region& region, Chart chart, const std::vector<Lock>& locks) {
    double in_space = 0.0, flat = 0.0;
    for (const LengthConstraint& constraint : length_constraints(region, locks)) {
        in_space += constraint.length;
        for (const auto& [a, b] : constraint.edges) {
            flat += (chart.uv[static_cast<std::size_t>(a)] - chart.uv[static_cast<std::size_t>(b)])
                        .norm();
        }
    }
    const double scale =
        flat > 0.0 ? in_space / flat
                   : std::sqrt(surface_area(region) / std::abs(flat_area(region, chart.uv)));
    for (Vec2& p : chart.uv) p *= scale;
    return chart;
}

}  // namespace lastflat
