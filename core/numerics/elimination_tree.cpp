// Based on: Davis, "Direct Methods for Sparse Linear Systems", SIAM 2006.
#include "core/numerics/elimination_tree.h"

#include <algorithm>
#include <utility>

namespace lastflat {
std::vector<Index> elimination_tree(const SparseMatrix& upper) {
    const auto n = static_cast<Index>(upper.cols());
    std::vector<Index> parent(at(n), -1), ancestor(at(n), -1);
    for (Index k = 0; k < n; ++k) {
        for (SparseMatrix::InnerIterator entry(upper, k); entry; ++entry) {
            for (Index i = entry.index(); i != -1 && i < k;) {
                const Index next = std::exchange(ancestor[at(i)], k);
                if (next == -1) parent[at(i)] = k;
                i = next;
            }
        }
    }
    return parent;
}

std::vector<std::size_t> column_begins(const SparseMatrix& upper, const std::vector<Index>& parent,
                                       Index last) {
    std::vector<std::size_t> begin(at(last) + 1, 0);
    RowReach reach(parent);
    for (Index k = 0; k < static_cast<Index>(parent.size()); ++k) {
        for (const Index i : reach.find(upper, k)) {
            if (i < last) ++begin[at(i) + 1];
        }
    }
    for (Index k = 0; k < last; ++k) begin[at(k) + 1] += begin[at(k)];
    return begin;
}

std::span<const Index> RowReach::find(const SparseMatrix& upper, Index k) {
    const auto n = static_cast<Index>(parent_.size());
    Index top = n;
    marks_[at(k)] = k;
    for (SparseMatrix::InnerIterator entry(upper, k); entry; ++entry) {
        path_.clear();
        for (Index i = entry.index(); i < k && marks_[at(i)] != k; i = parent_[at(i)]) {
            path_.push_back(i);
            marks_[at(i)] = k;
        }
        while (!path_.empty()) {
            stack_[at(--top)] = path_.back();
            path_.pop_back();
        }
    }
    return {stack_.data() + top, at(n - top)};
}

}  // namespace lastflat
