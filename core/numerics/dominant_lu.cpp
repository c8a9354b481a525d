// Based on: Davis, "Direct Methods for Sparse Linear Systems", SIAM 2006.
#include "core/numerics/dominant_lu.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/numerics/elimination_tree.h"

namespace lastflat {
DominantLu::DominantLu(const SparseMatrix& matrix) {
    const SparseMatrix upper = matrix.triangularView<Eigen::Upper>();
    const SparseMatrix lower = SparseMatrix(matrix.transpose()).triangularView<Eigen::Upper>();
    parent_ = elimination_tree(upper);
    begin_ = column_begins(upper, parent_, static_cast<Index>(upper.cols()));
    rows_.resize(begin_.back());
    L_.resize(begin_.back());
    U_.resize(begin_.back());
    factor(lower, upper);
}

/// Row by row: z is row k of L D, y is column k of D U, both by substitution over the reach.
void DominantLu::factor(const SparseMatrix& lower, const SparseMatrix& upper) {
    const std::size_t n = parent_.size();
    D_.resize(n);
    std::vector<double> y(n, 0.0), z(n, 0.0);
    std::vector<std::size_t> end(begin_.begin(), begin_.end() - 1);
    RowReach reach(parent_);
    for (Index k = 0; k < static_cast<Index>(n); ++k) {
        const auto row = reach.find(upper, k);
        for (SparseMatrix::InnerIterator entry(upper, k); entry; ++entry)
            y[at(entry.index())] = entry.value();
        for (SparseMatrix::InnerIterator entry(lower, k); entry; ++entry)
            z[at(entry.index())] = entry.value();
        double pivot = y[at(k)];
        y[at(k)] = z[at(k)] = 0.0;
        for (const Index column : row) {
            const std::size_t i = at(column);
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
