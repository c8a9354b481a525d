// One region at the least of its energy.
#pragma once

#include "core/border/convex_border.h"
#include "core/constrain/constraint_rows.h"
#include "core/constrain/resolve_conflicts.h"
#include "core/parameterize/fixed_border.h"
#include "tests/helpers/constraints.h"

namespace lastflat::test {

inline Minimum minimised(const Region& region, const Chart& start,
                         const std::vector<Constraint>& constraints = {},
                         const IsotropicEnergy& energy = SymmetricDirichlet(),
                         const Progress& progress = Progress()) {
    const Domain domain({&region});
    const Distortion distortion(domain, energy);
    const Problem free{domain, distortion};
    Problem problem = free;
    for (const ConstraintRow& row : constraint_rows(domain, constraints))
        problem.rows.push_back(row);
    OptimalitySystem system;
    return minimise_distortion(free, problem, {start}, system, progress);
}

/// The same with its conflicts resolved and its border kept from crossing.
inline ConstrainedChart flattened(const std::vector<const Region*>& regions,
                                  const std::vector<Constraint>& constraints,
                                  OnConflict on_conflict = OnConflict::fail,
                                  std::size_t threads = 1) {
    const Domain domain(regions);
    std::vector<Chart> starts;
    for (const Region* region : regions)
        starts.push_back(flatten_fixed_border(*region, mean_value_weights, circle_border(*region)));
    const SymmetricDirichlet energy;
    return least_distortion(domain, starts, {constraints, energy, {}, on_conflict, true}, threads,
                            Progress());
}

}  // namespace lastflat::test
