// One region at the least of its energy.
#pragma once

#include "core/constrain/constrained_newton.h"

namespace lastflat::test {

inline Minimum minimised(const Region& region, const Chart& start,
                         const std::vector<Constraint>& constraints = {},
                         const IsotropicEnergy& energy = SymmetricDirichlet(),
                         const Progress& progress = Progress()) {
    const Domain domain({&region});
    const auto rows = constraint_rows(domain, constraints);
    return minimise_distortion({domain, rows, energy}, {start}, progress);
}

}  // namespace lastflat::test
