#include "core/numerics/multifrontal_lu.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace lastflat {
namespace {

using Block = Eigen::Ref<Eigen::MatrixXd>;

/// A small block in place. False if a pivot vanishes.
bool factor_block(Block block) {
    for (Eigen::Index j = 0; j < block.cols(); ++j) {
        const double pivot = block(j, j);
        if (!std::isfinite(pivot) || pivot == 0.0) return false;
        const Eigen::Index below = block.rows() - j - 1;
        block.col(j).tail(below) /= pivot;
        block.bottomRightCorner(below, below).noalias() -=
            block.col(j).tail(below) * block.row(j).tail(below);
    }
    return true;
}

/// The panels of a front, a strip of columns at a time. False if a pivot vanishes.
bool factor_front(Block left, Block right) {
    constexpr Eigen::Index at_once = 32;
    const Eigen::Index width = left.cols(), height = left.rows();
    for (Eigen::Index begin = 0; begin < width; begin += at_once) {
        const Eigen::Index end = std::min(width, begin + at_once), size = end - begin;
        auto pivots = left.block(begin, begin, size, size);
        if (!factor_block(pivots)) return false;
        auto below = left.block(end, begin, height - end, size);
        auto beside = left.block(begin, end, size, width - end);
        pivots.triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(below);
        pivots.triangularView<Eigen::UnitLower>().solveInPlace(beside);
        left.block(end, end, height - end, width - end).noalias() -= below * beside;
        if (right.rows() == 0) continue;  // nothing lies above
        auto beyond = right.middleCols(begin, size);
        pivots.transpose().triangularView<Eigen::UnitUpper>().solveInPlace<Eigen::OnTheRight>(
            beyond);
        right.rightCols(width - end).noalias() -=
            beyond * left.block(end, begin, width - end, size).transpose();
    }
    return true;
}

}  // namespace

MultifrontalLu::MultifrontalLu(const SparseMatrix& matrix,
                               const std::vector<UnknownBlock>& blocks) {
    const SparseMatrix lower = matrix.triangularView<Eigen::Lower>();
    const SparseMatrix upper = SparseMatrix(matrix.transpose()).triangularView<Eigen::Lower>();
    tree_.analyse(lower, blocks);
    left_.resize(static_cast<Eigen::Index>(tree_.panels_size()));
    std::size_t size = 0;
    for (const Front& front : tree_.fronts()) {
        right_begin_.push_back(size);
        size += front.rows * front.width();
    }
    right_.resize(static_cast<Eigen::Index>(size));
    updates_.resize(tree_.fronts().size());
    Eigen::MatrixXd schur;
    for (std::size_t f = 0; f < tree_.fronts().size(); ++f) {
        const Front& front = tree_.fronts()[f];
        assemble(front, {lower.valuePtr(), upper.valuePtr()}, schur);
        auto own = left(front);
        auto beyond = right(front);
        if (!factor_front(own, beyond))
            throw Error(ErrorCode::solver_failed, "a linear system is singular");
        const auto rows = static_cast<Eigen::Index>(front.rows);
        if (rows > 0) schur.noalias() -= own.bottomRows(rows) * beyond.transpose();
        for (const Index c : front.children) updates_[at(c)] = {};
        updates_[f] = std::move(schur);
    }
}

MultifrontalLu::Dense MultifrontalLu::left(const Front& front) {
    return {left_.data() + front.panel, static_cast<Eigen::Index>(front.height()), front.columns};
}
MultifrontalLu::ConstDense MultifrontalLu::left(const Front& front) const {
    return {left_.data() + front.panel, static_cast<Eigen::Index>(front.height()), front.columns};
}
MultifrontalLu::Dense MultifrontalLu::right(const Front& front) {
    const auto f = static_cast<std::size_t>(&front - tree_.fronts().data());
    return {right_.data() + right_begin_[f], static_cast<Eigen::Index>(front.rows), front.columns};
}
MultifrontalLu::ConstDense MultifrontalLu::right(const Front& front) const {
    const auto f = static_cast<std::size_t>(&front - tree_.fronts().data());
    return {right_.data() + right_begin_[f], static_cast<Eigen::Index>(front.rows), front.columns};
}

/// The panels, and the rest of the front in `schur`: entries and the children's updates.
void MultifrontalLu::assemble(const Front& front, const Values& values, Eigen::MatrixXd& schur) {
    auto own = left(front);
    auto beyond = right(front);
    own.setZero();
    beyond.setZero();
    schur.setZero(static_cast<Eigen::Index>(front.rows), static_cast<Eigen::Index>(front.rows));
    for (std::size_t e = front.entries_begin; e < front.entries_end; ++e) {
        const FrontTree::Entry& entry = tree_.entries()[e];
        own(entry.row, entry.column) += values.lower[entry.from];
        if (entry.row == entry.column) continue;
        if (entry.row < front.columns)
            own(entry.column, entry.row) += values.upper[entry.from];
        else
            beyond(entry.row - front.columns, entry.column) += values.upper[entry.from];
    }
    for (const Index c : front.children) add_update(tree_.front(c), updates_[at(c)], front, schur);
}

void MultifrontalLu::add_update(const Front& child, const Eigen::MatrixXd& update,
                                const Front& front, Eigen::MatrixXd& schur) {
    tree_.find_slots(child, front, slots_);
    auto own = left(front);
    auto beyond = right(front);
    const Index width = front.columns;
    for (Eigen::Index j = 0; j < update.cols(); ++j) {
        const Index column = slots_[static_cast<std::size_t>(j)];
        for (Eigen::Index i = 0; i < update.rows(); ++i) {
            const Index row = slots_[static_cast<std::size_t>(i)];
            if (column < width)
                own(row, column) += update(i, j);
            else if (row < width)
                beyond(column - width, row) += update(i, j);
            else
                schur(row - width, column - width) += update(i, j);
        }
    }
}

Eigen::MatrixXd MultifrontalLu::solve(const Eigen::MatrixXd& right_hand_sides) const {
    Eigen::MatrixXd x = right_hand_sides, rest;
    for (const Front& front : tree_.fronts()) {
        const auto panel = left(front);
        auto own = x.middleRows(front.first, front.columns);
        panel.topRows(front.columns).triangularView<Eigen::UnitLower>().solveInPlace(own);
        if (front.rows == 0) continue;
        rest.noalias() = panel.bottomRows(static_cast<Eigen::Index>(front.rows)) * own;
        for (std::size_t i = 0; i < front.rows; ++i)
            x.row(tree_.row(front, i)) -= rest.row(static_cast<Eigen::Index>(i));
    }
    for (auto front = tree_.fronts().rbegin(); front != tree_.fronts().rend(); ++front) {
        auto own = x.middleRows(front->first, front->columns);
        rest.resize(static_cast<Eigen::Index>(front->rows), x.cols());
        for (std::size_t i = 0; i < front->rows; ++i)
            rest.row(static_cast<Eigen::Index>(i)) = x.row(tree_.row(*front, i));
        if (front->rows > 0) own.noalias() -= right(*front).transpose() * rest;
        left(*front).topRows(front->columns).triangularView<Eigen::Upper>().solveInPlace(own);
    }
    return x;
}

}  // namespace lastflat
