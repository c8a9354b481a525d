// Based on: Duff, Reid, "The Multifrontal Solution of Indefinite Sparse Symmetric Linear
// Equations", ACM TOMS 1983; Liu, "The Multifrontal Method for Sparse Matrix Solution: Theory and
// Practice", SIAM Review 1992; Vanderbei, "Symmetric Quasidefinite Matrices", SIAM J. Optimization
// 1995.
#include "core/numerics/multifrontal_ldlt.h"

#include <algorithm>

#include "core/parallel.h"

namespace lastflat {

void MultifrontalLdlt::analyse(const SparseMatrix& lower, const std::vector<UnknownBlock>& blocks) {
    tree_.analyse(lower, blocks);
    work_.assign(tree_.tasks().size(), {});
    for (std::size_t t = 0; t < work_.size(); ++t)
        work_[t].stack.resize(static_cast<Eigen::Index>(tree_.tasks()[t].stack));
    values_.resize(static_cast<Eigen::Index>(tree_.panels_size()));
    updates_.resize(tree_.fronts().size());
}

bool MultifrontalLdlt::factor(const SparseMatrix& lower, const Progress& progress,
                              std::size_t threads) {
    std::vector<char> sound(work_.size(), 0);
    for_each_index(work_.size() - 1, threads,
                   [&](std::size_t t) { sound[t] = run(t, lower.valuePtr(), progress) ? 1 : 0; });
    if (std::count(sound.begin(), sound.end(), 0) > 1) return false;
    return run(work_.size() - 1, lower.valuePtr(), progress);
}

bool MultifrontalLdlt::run(std::size_t t, const double* matrix, const Progress& progress) {
    Work& work = work_[t];
    std::size_t top = 0;
    for (const Index f : tree_.tasks()[t].fronts) {
        progress.check();
        const Front& front = tree_.front(f);
        double* schur = work.stack.data() + top;
        assemble(front, matrix, schur, work.slots);
        const Panel panel{values_.data() + front.panel, front.height(), front.width()};
        if (!factor_panel(panel, work.buffers)) return false;
        subtract_outer_product(panel, schur, work.buffers);
        // The update takes the place of the children's, which are the last on the stack.
        for (const Index c : front.children) {
            if (tree_.task_of(c) == t) top -= tree_.update_size(c);
        }
        double* room = work.stack.data() + top;
        for (std::size_t j = 0; j < front.rows; ++j) {  // its lower triangle
            const std::size_t first = j * front.rows + j;
            std::copy_n(schur + first, front.rows - j, room + first);
        }
        updates_[at(f)] = room;
        top += tree_.update_size(f);
    }
    return true;
}

/// The front's panel, and the rest of it in `schur`: entries of the matrix and the children's
/// updates.
void MultifrontalLdlt::assemble(const Front& front, const double* matrix, double* schur,
                                std::vector<Index>& slots) {
    double* panel = values_.data() + front.panel;
    const std::size_t height = front.height();
    std::fill_n(panel, height * front.width(), 0.0);
    for (std::size_t j = 0; j < front.rows; ++j)
        std::fill_n(schur + j * front.rows + j, front.rows - j, 0.0);
    for (std::size_t e = front.entries_begin; e < front.entries_end; ++e) {
        const FrontTree::Entry& entry = tree_.entries()[e];
        panel[at(entry.column) * height + at(entry.row)] += matrix[entry.from];
    }
    for (const Index c : front.children) {
        add_update(tree_.front(c), updates_[at(c)], front, schur, slots);
    }
}

void MultifrontalLdlt::add_update(const Front& child, const double* update, const Front& front,
                                  double* schur, std::vector<Index>& slots) {
    tree_.find_slots(child, front, slots);
    const std::size_t height = front.height(), width = front.width();
    double* panel = values_.data() + front.panel;
    for (std::size_t j = 0; j < child.rows; ++j) {
        const std::size_t column = at(slots[j]);
        const bool own = column < width;
        double* to = own ? panel + column * height : schur + (column - width) * front.rows;
        const Index first = own ? 0 : front.columns;
        for (std::size_t i = j; i < child.rows; ++i)
            to[slots[i] - first] += update[j * child.rows + i];
    }
}

Index MultifrontalLdlt::negative_pivots() const {
    Index negative = 0;
    for (const Front& front : tree_.fronts()) {
        for (std::size_t j = 0; j < front.width(); ++j) {
            if (values_.data()[front.panel + j * front.height() + j] < 0.0) ++negative;
        }
    }
    return negative;
}

Eigen::VectorXd MultifrontalLdlt::solve(const Eigen::VectorXd& right_hand_side,
                                        std::size_t threads) const {
    Eigen::VectorXd x(right_hand_side.size());
    for (std::size_t i = 0; i < tree_.positions().size(); ++i)
        x[tree_.positions()[i]] = right_hand_side[static_cast<Eigen::Index>(i)];
    const std::size_t above = work_.size() - 1;
    std::vector<Eigen::VectorXd> passed_on(above);
    for_each_index(above, threads, [&](std::size_t t) { passed_on[t] = go_up(t, x); });
    for (std::size_t t = 0; t < above; ++t) {
        const Front& top = tree_.front(tree_.tasks()[t].fronts.back());
        for (std::size_t i = 0; i < top.rows; ++i)
            x[tree_.row(top, i)] -= passed_on[t][static_cast<Eigen::Index>(i)];
    }
    (void)go_up(above, x);
    go_down(above, x);
    for_each_index(above, threads, [&](std::size_t t) { go_down(t, x); });
    Eigen::VectorXd result(x.size());
    for (std::size_t i = 0; i < tree_.positions().size(); ++i)
        result[static_cast<Eigen::Index>(i)] = x[tree_.positions()[i]];
    return result;
}

MultifrontalLdlt::ConstPanel MultifrontalLdlt::panel_of(const Front& front) const {
    return {values_.data() + front.panel, static_cast<Eigen::Index>(front.height()), front.columns};
}

/// Eliminates a task's unknowns. Returns what it takes from the rows of its last front, which are
/// those of other tasks.
Eigen::VectorXd MultifrontalLdlt::go_up(std::size_t t, Eigen::VectorXd& x) const {
    const std::vector<Index>& fronts = tree_.tasks()[t].fronts;
    Eigen::VectorXd passed_on, rest;
    if (fronts.empty()) return passed_on;
    const Front& top = tree_.front(fronts.back());
    const Index end = top.first + top.columns;
    passed_on.setZero(static_cast<Eigen::Index>(top.rows));
    for (const Index f : fronts) {
        const Front& front = tree_.front(f);
        const auto panel = panel_of(front);
        auto own = x.segment(front.first, front.columns);
        panel.topRows(front.columns).triangularView<Eigen::UnitLower>().solveInPlace(own);
        rest.noalias() = panel.bottomRows(static_cast<Eigen::Index>(front.rows)) * own;
        own.array() /= panel.diagonal().array();
        std::size_t i = 0, beyond = 0;
        for (; i < front.rows && tree_.row(front, i) < end; ++i)
            x[tree_.row(front, i)] -= rest[static_cast<Eigen::Index>(i)];
        for (; i < front.rows; ++i) {
            while (tree_.row(top, beyond) != tree_.row(front, i)) ++beyond;
            passed_on[static_cast<Eigen::Index>(beyond)] += rest[static_cast<Eigen::Index>(i)];
        }
    }
    return passed_on;
}

/// Puts in what is known above.
void MultifrontalLdlt::go_down(std::size_t t, Eigen::VectorXd& x) const {
    const std::vector<Index>& fronts = tree_.tasks()[t].fronts;
    Eigen::VectorXd rest;
    for (auto f = fronts.rbegin(); f != fronts.rend(); ++f) {
        const Front& front = tree_.front(*f);
        const auto panel = panel_of(front);
        auto own = x.segment(front.first, front.columns);
        rest.resize(static_cast<Eigen::Index>(front.rows));
        for (std::size_t i = 0; i < front.rows; ++i)
            rest[static_cast<Eigen::Index>(i)] = x[tree_.row(front, i)];
        own.noalias() -= panel.bottomRows(static_cast<Eigen::Index>(front.rows)).transpose() * rest;
        panel.topRows(front.columns)
            .triangularView<Eigen::UnitLower>()
            .transpose()
            .solveInPlace(own);
    }
}

}  // namespace lastflat
