// Cholesky factors of sparse symmetric positive definite matrices.
#pragma once

#include <Eigen/Cholesky>
#include <span>
#include <vector>

#include "core/numerics/types.h"

namespace lastflat {

/// A = L D L^T, row by row, with a dense tail: the last columns of a factor fill up, and there a
/// dense factorization is several times as fast as a sparse one.
///
/// Paper:  [davis-2006], section 4.7 (up-looking).
/// In:     the upper triangle of the matrix, its rows in an order of little fill.
/// Throws: Error{solver_failed} if it is not positive definite.
class SpdCholesky {
public:
    explicit SpdCholesky(const SparseMatrix& upper);
    [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& right_hand_side) const;

private:
    /// Eliminates the row `y` of L D by the columns that it reaches, and appends it to them;
    /// returns what the elimination takes from its pivot.
    double eliminate(std::span<const Index> columns, Index k, std::vector<double>& y);
    double append(std::size_t column, Index k, double value);

    std::vector<bool> nested_;        ///< per column of L: see `nested_columns`
    std::vector<std::size_t> end_;    ///< per column, where its next entry goes
    std::vector<std::size_t> begin_;  ///< per column of L before the tail, its entries
    std::vector<Index> rows_;
    std::vector<double> L_, D_;
    Eigen::LLT<Eigen::MatrixXd> tail_;
};

}  // namespace lastflat
