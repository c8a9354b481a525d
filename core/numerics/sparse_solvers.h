// Symmetric systems. The only place that names Eigen's factorizations, so that one file changes if
// the solver does.
#pragma once

#include <memory>

#include "core/numerics/types.h"

namespace lastflat {

/// LDL^T of symmetric quasi-definite matrices of one pattern: analysed once, factored often.
class QuasiDefiniteSolver {
public:
    QuasiDefiniteSolver();
    ~QuasiDefiniteSolver();

    /// Chooses the elimination order. `lower`: the lower triangle; only its pattern matters.
    void analyse(const SparseMatrix& lower);

    /// Factors a matrix of the analysed pattern. False if a pivot vanishes.
    [[nodiscard]] bool factor(const SparseMatrix& lower);

    /// How many eigenvalues of the factored matrix are negative (Sylvester's law of inertia).
    [[nodiscard]] Index negative_pivots() const;

    [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& right_hand_side) const;

private:
    struct Factor;
    std::unique_ptr<Factor> factor_;
};

}  // namespace lastflat
