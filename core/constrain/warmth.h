// What stays warm between two solves.
#pragma once

#include "core/optimize/optimality_system.h"

namespace lastflat {

/// Where a solve of a domain ended, and with which rows and system: a later one of the same domain
/// may begin there.
struct Warmth {
    std::vector<Row> rows;
    Iterate iterate;
    OptimalitySystem system;
    OptimalitySystem spare{};  ///< where `refresh` makes the next factor

    [[nodiscard]] bool is_empty() const { return iterate.x.size() == 0; }
};

/// Whether the rows are about the same: they couple the same points in the same way, whatever their
/// bounds are.
[[nodiscard]] bool are_alike(const std::vector<Row>& a, const std::vector<Row>& b);

/// A multiplier for each of the rows: that which a row about the same had, or zero.
[[nodiscard]] Eigen::VectorXd carried_multipliers(const Warmth& warmth,
                                                  const std::vector<Row>& rows);

}  // namespace lastflat
