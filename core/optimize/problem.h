// Minimise what, under which rows.
#pragma once

#include "core/optimize/distortion.h"
#include "core/optimize/row.h"

namespace lastflat {

/// What it refers to must outlive it.
struct Problem {
    const Domain& domain;
    const Distortion& distortion;
    std::vector<const EnergyTerm*> terms{};  ///< that cost energy beside it; none is null
    std::vector<Row> rows{};
    std::size_t threads = 1;

    /// Distortion and terms.
    [[nodiscard]] std::vector<const EnergyTerm*> energy() const {
        std::vector<const EnergyTerm*> all{&distortion};
        all.insert(all.end(), terms.begin(), terms.end());
        return all;
    }
};

}  // namespace lastflat
