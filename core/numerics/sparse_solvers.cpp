#include "core/numerics/sparse_solvers.h"

#include <Eigen/SparseCholesky>

namespace lastflat {

struct QuasiDefiniteSolver::Factor {
    Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower> ldlt;
};

QuasiDefiniteSolver::QuasiDefiniteSolver() : factor_(std::make_unique<Factor>()) {}
QuasiDefiniteSolver::~QuasiDefiniteSolver() = default;

void QuasiDefiniteSolver::analyse(const SparseMatrix& lower) {
    factor_->ldlt.analyzePattern(lower);
}

bool QuasiDefiniteSolver::factor(const SparseMatrix& lower) {
    factor_->ldlt.factorize(lower);
    return factor_->ldlt.info() == Eigen::Success;
}

Index QuasiDefiniteSolver::negative_pivots() const {
    return static_cast<Index>((factor_->ldlt.vectorD().array() < 0.0).count());
}

Eigen::VectorXd QuasiDefiniteSolver::solve(const Eigen::VectorXd& right_hand_side) const {
    return factor_->ldlt.solve(right_hand_side);
}

}  // namespace lastflat
