// Sparse symmetric systems of one pattern, factored often.
#pragma once

#include <vector>

#include "core/numerics/dense_ldlt.h"
#include "core/numerics/types.h"
#include "core/progress.h"

namespace lastflat {

/// Unknowns that are eliminated together; see `EliminationBlock`.
struct UnknownBlock {
    Index parent;
    std::vector<Index> unknowns;
};

/// A = L D L^T of symmetric positive definite or quasi-definite matrices: every block of unknowns
/// is a small dense matrix, its front, that takes the updates of its children and passes one on to
/// its parent.
///
/// Paper: [duff-1983], [liu-1992]; quasi-definite matrices need no pivoting: [vanderbei-1995].
class MultifrontalLdlt {
public:
    /// `lower`: the lower triangle, compressed; only its pattern matters, and later matrices have
    /// the same. `blocks`: every unknown once, children before parents; blocks of different
    /// branches share no entry.
    void analyse(const SparseMatrix& lower, const std::vector<UnknownBlock>& blocks);

    /// Factors a matrix of the analysed pattern. False if a pivot vanishes.
    /// The answer does not depend on `threads`.
    /// Throws: Error{canceled}.
    [[nodiscard]] bool factor(const SparseMatrix& lower, const Progress& progress,
                              std::size_t threads = 1);

    /// How many eigenvalues of the factored matrix are negative (Sylvester's law of inertia).
    [[nodiscard]] Index negative_pivots() const;

    [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& right_hand_side) const;

    /// Entries of the factor, its pivots included.
    [[nodiscard]] std::size_t entries() const { return values_.size(); }

private:
    struct Front {
        Index parent;
        Index first, columns;          ///< of its unknowns, in elimination order
        std::size_t rows_begin, rows;  ///< in rows_: positions of later unknowns, ascending
        std::size_t panel;             ///< in values_
        std::size_t entries_begin, entries_end;  ///< in entries_
        std::vector<Index> children;
        [[nodiscard]] std::size_t width() const { return static_cast<std::size_t>(columns); }
        [[nodiscard]] std::size_t height() const { return width() + rows; }
    };
    /// Where an entry of the matrix goes in its front's panel.
    struct Entry {
        std::size_t from;
        Index row, column;
    };
    struct Task {
        std::vector<Index> fronts;
        std::vector<double> stack;  ///< updates that their parents have not taken yet
        std::size_t top = 0;
        std::vector<Index> slots;  ///< of an update's rows in its parent's front
        PackBuffers buffers;
    };

    void sort_entries(const SparseMatrix& lower);
    void find_rows();
    void choose_tasks();
    void reserve_stack(std::size_t task);
    [[nodiscard]] std::size_t update_size(Index front) const;
    [[nodiscard]] bool run(std::size_t task, const double* matrix, const Progress& progress);
    void assemble(const Front& front, const double* matrix, double* schur, Task& task);
    void add_update(const Front& child, const double* update, const Front& front, double* schur,
                    std::vector<Index>& slots);

    std::vector<Front> fronts_;
    std::vector<Index> position_;  ///< per unknown, when it is eliminated
    std::vector<Index> front_at_;  ///< per position, its front
    std::vector<Index> rows_;
    std::vector<Entry> entries_;          ///< front by front
    std::vector<Task> tasks_;             ///< branches, independent; the last: what lies above
    std::vector<std::size_t> task_of_;    ///< per front
    std::vector<const double*> updates_;  ///< per front, while its parent has not taken it
    std::vector<double> values_;
};

}  // namespace lastflat
