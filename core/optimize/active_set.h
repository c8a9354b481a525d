// Which rows are held at which of their bounds.
#pragma once

#include "core/optimize/row.h"

namespace lastflat {

/// Which bound of a row holds it now. Equations are held by both.
enum class Held : signed char { by_least = -1, not_held = 0, by_most = 1 };

/// Inequalities are held or let go by the sign of their multiplier.
///
/// Paper: [hintermueller-2002].
struct ActiveSet {
    std::vector<Held> held;     ///< per row
    std::vector<int> releases;  ///< per row, how often it was let go
    /// A row pulls the wrong way and is not let go any more.
    bool undecided = false;

    /// Equations are held; inequalities by the bound that their multiplier says, if they are there
    /// or beyond. The multiplier of those that are not held becomes zero.
    ActiveSet(const std::vector<Row>& rows, const Eigen::VectorXd& values,
              Eigen::VectorXd& multipliers);

    /// Holds what is violated, lets go what pulls the wrong way; its multiplier becomes zero.
    /// `values`: of the rows. Returns whether anything changed.
    [[nodiscard]] bool update(const std::vector<Row>& rows, const Eigen::VectorXd& values,
                              Eigen::VectorXd& multipliers);

    /// Holds what is not held and violated at these values. Returns whether there was any.
    [[nodiscard]] bool hold_violated(const std::vector<Row>& rows, const Eigen::VectorXd& values);

    /// Per row, how far it is from the bound that holds it; zero: none does.
    [[nodiscard]] Eigen::VectorXd residual(const std::vector<Row>& rows,
                                           const Eigen::VectorXd& values) const;

    /// The residual of exact rows; a soft one's force is its error, so nothing of it is left.
    [[nodiscard]] Eigen::VectorXd exact_residual(const std::vector<Row>& rows,
                                                 const Eigen::VectorXd& values) const;
};

}  // namespace lastflat
