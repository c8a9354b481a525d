// Based on: Davis, "Direct Methods for Sparse Linear Systems", SIAM 2006.
#include "core/numerics/dominant_lu.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"

namespace lastflat {
namespace {

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}

/// Visits the columns i < k that row k of L reaches in the elimination tree, descendants first.
/// `marks` holds, per column, the last row that visited it.
class RowReach {
public:
    explicit RowReach(const std::vector<Index>& parent)
        : parent_(parent), marks_(parent.size(), -1), stack_(parent.size()) {}

    /// The pattern of row k, given the entries of column k of the upper triangle.
    const Index* find(const SparseMatrix& upper, Index k, Index& count) {
        const auto n = static_cast<Index>(parent_.size());
        Index top = n;
        marks_[at(k)] = k;
        for (SparseMatrix::InnerIterator entry(upper, k); entry; ++entry) {
            Index length = 0;
            for (Index i = entry.index(); i < k && marks_[at(i)] != k; i = parent_[at(i)]) {
                path_.resize(at(std::max(length + 1, static_cast<Index>(path_.size()))));
                path_[at(length++)] = i;
                marks_[at(i)] = k;
            }
            while (length > 0) stack_[at(--top)] = path_[at(--length)];
        }
        count = n - top;
        return stack_.data() + top;
    }

private:
    const std::vector<Index>& parent_;
    std::vector<Index> marks_, stack_, path_;
};

}  // namespace

DominantLu::DominantLu(const SparseMatrix& matrix) {
    const SparseMatrix upper = matrix.triangularView<Eigen::Upper>();
    const SparseMatrix lower = SparseMatrix(matrix.transpose()).triangularView<Eigen::Upper>();
    analyse(upper);
    factor(lower, upper);
}

void DominantLu::analyse(const SparseMatrix& upper) {
    const auto n = static_cast<Index>(upper.cols());
    parent_.assign(at(n), -1);
    std::vector<Index> ancestor(at(n), -1);
    std::vector<std::size_t> counts(at(n), 0);
    for (Index k = 0; k < n; ++k) {  // Liu's algorithm, with path compression
        for (SparseMatrix::InnerIterator entry(upper, k); entry; ++entry) {
            for (Index i = entry.index(); i != -1 && i < k;) {
                const Index next = std::exchange(ancestor[at(i)], k);
                if (next == -1) parent_[at(i)] = k;
                i = next;
            }
        }
    }
    RowReach reach(parent_);
    for (Index k = 0; k < n; ++k) {
        Index count = 0;
        const Index* row = reach.find(upper, k, count);
        for (Index j = 0; j < count; ++j) ++counts[at(row[j])];
    }
    begin_.assign(at(n) + 1, 0);
    for (Index k = 0; k < n; ++k) begin_[at(k) + 1] = begin_[at(k)] + counts[at(k)];
    rows_.resize(begin_.back());
    L_.resize(begin_.back());
    U_.resize(begin_.back());
}

/// Row by row: z is row k of L D, y is column k of D U, both by substitution over the reach.
void DominantLu::factor(const SparseMatrix& lower, const SparseMatrix& upper) {
    const std::size_t n = parent_.size();
    D_.resize(n);
    std::vector<double> y(n, 0.0), z(n, 0.0);
    std::vector<std::size_t> end(begin_.begin(), begin_.end() - 1);
    RowReach reach(parent_);
    for (Index k = 0; k < static_cast<Index>(n); ++k) {
        Index count = 0;
        const Index* row = reach.find(upper, k, count);
        for (SparseMatrix::InnerIterator entry(upper, k); entry; ++entry)
            y[at(entry.index())] = entry.value();
        for (SparseMatrix::InnerIterator entry(lower, k); entry; ++entry)
            z[at(entry.index())] = entry.value();
        double pivot = y[at(k)];
        y[at(k)] = z[at(k)] = 0.0;
        for (Index j = 0; j < count; ++j) {
            const std::size_t i = at(row[j]);
            const double y_i = std::exchange(y[i], 0.0), z_i = std::exchange(z[i], 0.0);
            for (std::size_t p = begin_[i]; p < end[i]; ++p) {
                y[at(rows_[p])] -= L_[p] * y_i;
                z[at(rows_[p])] -= U_[p] * z_i;
            }
            pivot -= z_i * y_i / D_[i];
            rows_[end[i]] = k;
            L_[end[i]] = z_i / D_[i];
            U_[end[i]++] = y_i / D_[i];
        }
        if (!std::isfinite(pivot) || pivot == 0.0) {
            throw Error(ErrorCode::solver_failed, "a linear system is singular");
        }
        D_[at(k)] = pivot;
    }
}

Eigen::MatrixXd DominantLu::solve(const Eigen::MatrixXd& right_hand_side) const {
    Eigen::MatrixXd x = right_hand_side;
    const auto n = static_cast<Index>(D_.size());
    for (Eigen::Index column = 0; column < x.cols(); ++column) {
        double* v = x.col(column).data();
        for (Index i = 0; i < n; ++i) {
            for (std::size_t p = begin_[at(i)]; p < begin_[at(i) + 1]; ++p)
                v[rows_[p]] -= L_[p] * v[i];
        }
        for (Index i = n; i-- > 0;) {
            double sum = v[i] / D_[at(i)];
            for (std::size_t p = begin_[at(i)]; p < begin_[at(i) + 1]; ++p)
                sum -= U_[p] * v[rows_[p]];
            v[i] = sum;
        }
    }
    return x;
}

}  // namespace lastflat
