// Sparse symmetric systems of one pattern, factored often.
#pragma once

#include <vector>

#include "core/numerics/dense_ldlt.h"
#include "core/numerics/front_tree.h"
#include "core/progress.h"

namespace lastflat {

/// A = L D L^T of symmetric positive definite or quasi-definite matrices, front by front.
///
/// Paper: see `FrontTree`; quasi-definite matrices need no pivoting: [vanderbei-1995].
class MultifrontalLdlt {
public:
    /// See `FrontTree::analyse`; later matrices have the same pattern.
    void analyse(const SparseMatrix& lower, const std::vector<UnknownBlock>& blocks);

    /// Factors a matrix of the analysed pattern. False if a pivot vanishes.
    /// The answer does not depend on `threads`.
    /// Throws: Error{canceled}.
    [[nodiscard]] bool factor(const SparseMatrix& lower, const Progress& progress,
                              std::size_t threads = 1);

    /// How many eigenvalues of the factored matrix are negative (Sylvester's law of inertia).
    [[nodiscard]] Index negative_pivots() const;

    /// The answer does not depend on `threads`.
    [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& right_hand_side,
                                        std::size_t threads = 1) const;

    /// Entries of the factor, its pivots included.
    [[nodiscard]] std::size_t entries() const { return static_cast<std::size_t>(values_.size()); }

private:
    using Front = FrontTree::Front;
    using ConstPanel = Eigen::Map<const Eigen::MatrixXd>;
    /// What a task needs.
    struct Work {
        Eigen::VectorXd stack;     ///< updates that their parents have not taken yet
        std::vector<Index> slots;  ///< of an update's rows in its parent's front
        PackBuffers buffers;
    };

    [[nodiscard]] bool run(std::size_t task, const double* matrix, const Progress& progress);
    void assemble(const Front& front, const double* matrix, double* schur,
                  std::vector<Index>& slots);
    void add_update(const Front& child, const double* update, const Front& front, double* schur,
                    std::vector<Index>& slots);
    [[nodiscard]] ConstPanel panel_of(const Front& front) const;
    [[nodiscard]] Eigen::VectorXd go_up(std::size_t task, Eigen::VectorXd& x) const;
    void go_down(std::size_t task, Eigen::VectorXd& x) const;

    FrontTree tree_;
    std::vector<Work> work_;              ///< per task
    std::vector<const double*> updates_;  ///< per front, while its parent has not taken it
    Eigen::VectorXd values_;
};

}  // namespace lastflat
