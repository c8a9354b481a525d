// Which columns of a sparse triangular factor an elimination touches.
#pragma once

#include <span>

#include "core/numerics/types.h"

namespace lastflat {

/// The elimination tree of a matrix of symmetric pattern: per column the first row below the
/// diagonal in which the factor has an entry, -1 at roots.
///
/// Paper: [davis-2006], section 4.1 (Liu's algorithm, with path compression).
/// In:    the upper triangle; only its pattern matters.
[[nodiscard]] std::vector<Index> elimination_tree(const SparseMatrix& upper);

/// Per column of the factor, where its entries below the diagonal begin; one more for the end.
/// Only columns before `last` are counted.
[[nodiscard]] std::vector<std::size_t> column_begins(const SparseMatrix& upper,
                                                     const std::vector<Index>& parent, Index last);

/// Finds the columns i < k that row k of the factor reaches in the elimination tree.
class RowReach {
public:
    explicit RowReach(const std::vector<Index>& parent)
        : parent_(parent), marks_(parent.size(), -1), stack_(parent.size()) {}

    /// The pattern of row k, descendants first; rows must be asked for in ascending order.
    [[nodiscard]] std::span<const Index> find(const SparseMatrix& upper, Index k);

private:
    const std::vector<Index>& parent_;
    std::vector<Index> marks_;  ///< per column, the last row that visited it
    std::vector<Index> stack_, path_;
};

}  // namespace lastflat
