// Sparse systems whose pattern is symmetric though their values are not.
#pragma once

#include <vector>

#include "core/numerics/front_tree.h"

namespace lastflat {

/// A = L U with ones on L's diagonal, front by front, without pivoting: the pattern stays the
/// symmetric one.
///
/// Paper:  see `FrontTree`.
/// In:     a weakly diagonally dominant matrix (then no pivot vanishes unless it is singular),
///         compressed, every diagonal entry stored; `blocks` as `FrontTree` needs them, their
///         unknowns numbered one after the other.
/// Throws: Error{solver_failed} if a pivot is zero or not finite.
class MultifrontalLu {
public:
    MultifrontalLu(const SparseMatrix& matrix, const std::vector<UnknownBlock>& blocks);
    /// A right-hand side in each column.
    [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& right_hand_sides) const;

private:
    using Front = FrontTree::Front;
    using Dense = Eigen::Map<Eigen::MatrixXd>;
    using ConstDense = Eigen::Map<const Eigen::MatrixXd>;
    /// Per entry of the lower triangle, that of the matrix and that of its transpose.
    struct Values {
        const double *lower, *upper;
    };
    void assemble(const Front& front, const Values& values, Eigen::MatrixXd& schur);
    void add_update(const Front& child, const Eigen::MatrixXd& update, const Front& front,
                    Eigen::MatrixXd& schur);
    /// The pivot block, both factors in one, and below it the rows of L.
    [[nodiscard]] Dense left(const Front& front);
    [[nodiscard]] ConstDense left(const Front& front) const;
    /// Beside the pivot block the columns of U, transposed.
    [[nodiscard]] Dense right(const Front& front);
    [[nodiscard]] ConstDense right(const Front& front) const;

    FrontTree tree_;
    Eigen::VectorXd left_, right_;
    std::vector<std::size_t> right_begin_;  ///< per front
    std::vector<Eigen::MatrixXd> updates_;  ///< per front, while its parent has not taken it
    std::vector<Index> slots_;
};

}  // namespace lastflat
