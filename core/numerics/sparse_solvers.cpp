#include "core/numerics/sparse_solvers.h"

#include <Eigen/SparseCholesky>

#include "core/error.h"

namespace lastflat {

Eigen::MatrixXd solve_spd(const SparseMatrix& matrix, const Eigen::MatrixXd& right_hand_side) {
    const Eigen::SimplicialLLT<SparseMatrix, Eigen::Lower, Eigen::NaturalOrdering<Index>> factor(
        matrix);
    if (factor.info() != Eigen::Success) {
        throw Error(ErrorCode::solver_failed, "a linear system is not positive definite");
    }
    return factor.solve(right_hand_side);
}

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
