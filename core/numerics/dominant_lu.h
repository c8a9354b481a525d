// LU of matrices that need no pivoting.
#pragma once

#include <vector>

#include "core/numerics/types.h"

namespace lastflat {

/// A = L D U with unit triangles L, U for a matrix whose pattern is symmetric though its values are
/// not. Both triangles share one pattern, found once from the elimination tree, so it costs twice
/// an LDL^T and no search for pivots.
///
/// Paper:  [davis-2006], chapters 4 and 6 (up-looking, elimination tree).
/// In:     a weakly diagonally dominant matrix (then the pivots cannot vanish unless it is
///         singular), with every diagonal entry stored; its rows in an order of little fill.
/// Throws: Error{solver_failed} if a pivot is zero or not finite.
class DominantLu {
public:
    explicit DominantLu(const SparseMatrix& matrix);
    [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& right_hand_side) const;

private:
    void factor(const SparseMatrix& lower, const SparseMatrix& upper);

    std::vector<Index> parent_;       ///< elimination tree
    std::vector<std::size_t> begin_;  ///< per column of L (row of U), its entries
    std::vector<Index> rows_;
    std::vector<double> L_, U_, D_;
};

}  // namespace lastflat
