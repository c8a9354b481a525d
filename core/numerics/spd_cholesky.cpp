// Based on: Davis, "Direct Methods for Sparse Linear Systems", SIAM 2006.
#include "core/numerics/spd_cholesky.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/numerics/elimination_tree.h"

namespace lastflat {
namespace {

/// Where the columns begin that are at least a third full; the end, if those are too few to pay.
Index tail_begin(const std::vector<std::size_t>& begin) {
    constexpr Index fewest = 48;
    const auto n = static_cast<Index>(begin.size()) - 1;
    Index first = n;
    while (first > 0) {
        const std::size_t entries = begin[at(first)] - begin[at(first - 1)];
        if (3 * entries < at(n - first)) break;
        --first;
    }
    return n - first < fewest ? n : first;
}

/// Per column before the tail, whether its entries are the next column's and that column itself:
/// rows then take both at once, at half the traffic.
std::vector<bool> nested_columns(const std::vector<Index>& parent,
                                 const std::vector<std::size_t>& begin) {
    std::vector<bool> nested(begin.size(), false);
    for (std::size_t i = 0; i + 2 < begin.size(); ++i) {
        nested[i] =
            at(parent[i]) == i + 1 && begin[i + 1] - begin[i] == begin[i + 2] - begin[i + 1] + 1;
    }
    return nested;
}

[[noreturn]] void fail() {
    throw Error(ErrorCode::solver_failed, "a linear system is not positive definite");
}

}  // namespace

SpdCholesky::SpdCholesky(const SparseMatrix& upper) {
    const auto n = static_cast<Index>(upper.cols());
    const auto parent = elimination_tree(upper);
    begin_ = column_begins(upper, parent, n);
    const Index tail = tail_begin(begin_);
    begin_.resize(at(tail) + 1);
    rows_.resize(begin_.back());
    L_.resize(begin_.back());
    D_.resize(at(tail));
    Eigen::MatrixXd S = Eigen::MatrixXd::Zero(n - tail, n - tail);
    nested_ = nested_columns(parent, begin_);
    end_.assign(begin_.begin(), begin_.end() - 1);
    std::vector<double> y(at(n), 0.0);
    RowReach reach(parent);
    for (Index k = 0; k < n; ++k) {
        const auto row = reach.find(upper, k);
        for (SparseMatrix::InnerIterator entry(upper, k); entry; ++entry) {
            y[at(entry.index())] = entry.value();
        }
        const double pivot = std::exchange(y[at(k)], 0.0) - eliminate(row, k, y);
        if (k < tail) {
            if (!(pivot > 0.0) || !std::isfinite(pivot)) fail();
            D_[at(k)] = pivot;
        } else {  // what is left of the row is the tail's Schur complement
            S(k - tail, k - tail) = pivot;
            for (Index j = tail; j < k; ++j) S(k - tail, j - tail) = std::exchange(y[at(j)], 0.0);
        }
    }
    tail_.compute(S);
    if (n > tail && tail_.info() != Eigen::Success) fail();
}

double SpdCholesky::eliminate(std::span<const Index> columns, Index k, std::vector<double>& y) {
    double taken = 0.0;
    for (std::size_t c = 0; c < columns.size(); ++c) {
        const std::size_t i = at(columns[c]), j = i + 1;
        if (i >= D_.size()) continue;
        const double y_i = std::exchange(y[i], 0.0);
        if (nested_[i] && c + 1 < columns.size() && at(columns[c + 1]) == j) {
            // Column i holds j and then what column j holds.
            std::size_t p = begin_[i];
            const double y_j = std::exchange(y[j], 0.0) - L_[p++] * y_i;
            for (std::size_t q = begin_[j]; q < end_[j]; ++q, ++p) {
                y[at(rows_[q])] -= L_[p] * y_i + L_[q] * y_j;
            }
            taken += append(j, k, y_j);
            ++c;
        } else {
            for (std::size_t p = begin_[i]; p < end_[i]; ++p) y[at(rows_[p])] -= L_[p] * y_i;
        }
        taken += append(i, k, y_i);
    }
    return taken;
}

double SpdCholesky::append(std::size_t column, Index k, double value) {
    rows_[end_[column]] = k;
    L_[end_[column]++] = value / D_[column];
    return value * value / D_[column];
}

Eigen::VectorXd SpdCholesky::solve(const Eigen::VectorXd& right_hand_side) const {
    Eigen::VectorXd x = right_hand_side;
    const auto tail = static_cast<Index>(D_.size());
    for (Index i = 0; i < tail; ++i) {
        for (std::size_t p = begin_[at(i)]; p < begin_[at(i) + 1]; ++p) {
            x[rows_[p]] -= L_[p] * x[i];
        }
    }
    if (x.size() > tail) x.tail(x.size() - tail) = tail_.solve(x.tail(x.size() - tail)).eval();
    for (Index i = tail; i-- > 0;) {
        double sum = x[i] / D_[at(i)];
        for (std::size_t p = begin_[at(i)]; p < begin_[at(i) + 1]; ++p) sum -= L_[p] * x[rows_[p]];
        x[i] = sum;
    }
    return x;
}

}  // namespace lastflat
