#include "core/constrain/scale_to_locks.h"

#include <cmath>

#include "core/constrain/constraint_rows.h"

namespace lastflat {

Chart scaled_to_locks(const Region& region, Chart chart,
                      const std::vector<Constraint>& constraints) {
    std::vector<Constraint> locks;
    for (const Constraint& constraint : constraints) {
        if (std::holds_alternative<Lock>(constraint.demand)) locks.push_back(constraint);
    }
    const Domain domain({&region});
    const Eigen::VectorXd x = domain.coordinates({chart});
    double in_space = 0.0, flat = 0.0;
    for (const ConstraintRow& row : constraint_rows(domain, locks)) {
        in_space += row.most;
        flat += row.value(x);
    }
    const double scale =
        flat > 0.0 ? in_space / flat
                   : std::sqrt(surface_area(region) / std::abs(flat_area(region, chart.uv)));
    for (Vec2& p : chart.uv) p *= scale;
    return chart;
}

}  // namespace lastflat
