// Based on: Duff, Reid, "The Multifrontal Solution of Indefinite Sparse Symmetric Linear
// Equations", ACM TOMS 1983; Liu, "The Multifrontal Method for Sparse Matrix Solution: Theory and
// Practice", SIAM Review 1992; Vanderbei, "Symmetric Quasidefinite Matrices", SIAM J. Optimization
// 1995.
#include "core/numerics/multifrontal_ldlt.h"

#include <algorithm>

#include "core/parallel.h"

namespace lastflat {
namespace {

using ConstPanel = Eigen::Map<const Eigen::MatrixXd>;

/// Multiplications that a front takes, about.
double work_of(double columns, double height) {
    return columns * height * height;
}

}  // namespace

void MultifrontalLdlt::analyse(const SparseMatrix& lower, const std::vector<UnknownBlock>& blocks) {
    fronts_.clear();
    position_.assign(static_cast<std::size_t>(lower.cols()), -1);
    front_at_.clear();
    for (const UnknownBlock& block : blocks) {
        const auto front = static_cast<Index>(fronts_.size());
        const auto first = static_cast<Index>(front_at_.size());
        fronts_.push_back(
            {block.parent, first, static_cast<Index>(block.unknowns.size()), 0, 0, 0, 0, 0, {}});
        for (const Index unknown : block.unknowns) {
            position_[at(unknown)] = static_cast<Index>(front_at_.size());
            front_at_.push_back(front);
        }
    }
    for (std::size_t f = 0; f < fronts_.size(); ++f) {
        if (fronts_[f].parent >= 0)
            fronts_[at(fronts_[f].parent)].children.push_back(static_cast<Index>(f));
    }
    sort_entries(lower);
    find_rows();
    choose_tasks();
    std::size_t size = 0;
    for (Front& front : fronts_) {
        front.panel = size;
        size += front.height() * front.width();
    }
    values_.resize(size);
    updates_.resize(fronts_.size());
}

/// Entries by front, with the positions of their unknowns as row and column for now.
void MultifrontalLdlt::sort_entries(const SparseMatrix& lower) {
    std::vector<std::size_t> begin(fronts_.size() + 1, 0);
    const auto for_entries = [&](auto visit) {
        for (Index j = 0; j < static_cast<Index>(lower.cols()); ++j) {
            for (Index e = lower.outerIndexPtr()[j]; e < lower.outerIndexPtr()[j + 1]; ++e) {
                const Index p = position_[at(lower.innerIndexPtr()[e])], q = position_[at(j)];
                const Index column = std::min(p, q), row = std::max(p, q);
                visit(front_at_[at(column)], Entry{at(e), row, column});
            }
        }
    };
    for_entries([&](Index front, const Entry&) { ++begin[at(front) + 1]; });
    for (std::size_t f = 0; f < fronts_.size(); ++f) {
        begin[f + 1] += begin[f];
        fronts_[f].entries_begin = fronts_[f].entries_end = begin[f];
    }
    entries_.resize(begin.back());
    for_entries([&](Index front, const Entry& entry) {
        entries_[fronts_[at(front)].entries_end++] = entry;
    });
}

/// Which later unknowns every front touches, and where in it its entries go.
void MultifrontalLdlt::find_rows() {
    rows_.clear();
    std::vector<Index> rows, slot(position_.size());
    for (Front& front : fronts_) {
        const Index end = front.first + front.columns;
        rows.clear();
        for (std::size_t e = front.entries_begin; e < front.entries_end; ++e) {
            if (entries_[e].row >= end) rows.push_back(entries_[e].row);
        }
        for (const Index c : front.children) {
            const Front& child = fronts_[at(c)];
            for (std::size_t i = 0; i < child.rows; ++i) {
                const Index row = rows_[child.rows_begin + i];
                if (row >= end) rows.push_back(row);
            }
        }
        std::sort(rows.begin(), rows.end());
        rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
        front.rows_begin = rows_.size();
        front.rows = rows.size();
        rows_.insert(rows_.end(), rows.begin(), rows.end());
        for (Index i = 0; i < front.columns; ++i) slot[at(front.first + i)] = i;
        for (std::size_t i = 0; i < rows.size(); ++i)
            slot[at(rows[i])] = front.columns + static_cast<Index>(i);
        for (std::size_t e = front.entries_begin; e < front.entries_end; ++e) {
            entries_[e].row = slot[at(entries_[e].row)];
            entries_[e].column = slot[at(entries_[e].column)];
        }
    }
}

/// Splits the heaviest branch until there are enough of them for any machine to share; what lies
/// above the branches has to wait for them all.
void MultifrontalLdlt::choose_tasks() {
    constexpr std::size_t enough = 8;
    constexpr double too_small = 1e6;  // a thread costs as much
    std::vector<double> work(fronts_.size());
    std::vector<Index> tops;
    for (std::size_t f = 0; f < fronts_.size(); ++f) {
        const Front& front = fronts_[f];
        work[f] = work_of(front.columns, static_cast<double>(front.height()));
        for (const Index c : front.children) work[f] += work[at(c)];
        if (front.parent < 0) tops.push_back(static_cast<Index>(f));
    }
    const auto lighter = [&](Index a, Index b) { return work[at(a)] < work[at(b)]; };
    while (!tops.empty() && tops.size() < enough) {
        const auto heaviest = std::max_element(tops.begin(), tops.end(), lighter);
        const auto& children = fronts_[at(*heaviest)].children;
        if (work[at(*heaviest)] < too_small || children.empty()) break;
        tops.erase(heaviest);
        tops.insert(tops.end(), children.begin(), children.end());
    }
    std::sort(tops.begin(), tops.end());
    tasks_.assign(tops.size() + 1, {});
    task_of_.assign(fronts_.size(), tops.size());
    for (std::size_t t = 0; t < tops.size(); ++t) task_of_[at(tops[t])] = t;
    for (std::size_t f = fronts_.size(); f-- > 0;) {  // parents hand their task on
        const Index parent = fronts_[f].parent;
        if (parent >= 0 && task_of_[f] == tops.size()) task_of_[f] = task_of_[at(parent)];
    }
    for (std::size_t f = 0; f < fronts_.size(); ++f)
        tasks_[task_of_[f]].fronts.push_back(static_cast<Index>(f));
    for (std::size_t t = 0; t < tasks_.size(); ++t) reserve_stack(t);
}

std::size_t MultifrontalLdlt::update_size(Index front) const {
    return fronts_[at(front)].rows * fronts_[at(front)].rows;
}

void MultifrontalLdlt::reserve_stack(std::size_t task) {
    std::size_t top = 0, most = 0;
    for (const Index f : tasks_[task].fronts) {
        top += update_size(f);
        most = std::max(most, top);
        for (const Index c : fronts_[at(f)].children) {
            if (task_of_[at(c)] == task) top -= update_size(c);
        }
    }
    tasks_[task].stack.resize(most);
}

bool MultifrontalLdlt::factor(const SparseMatrix& lower, const Progress& progress,
                              std::size_t threads) {
    std::vector<char> sound(tasks_.size(), 0);
    for_each_index(tasks_.size() - 1, threads,
                   [&](std::size_t t) { sound[t] = run(t, lower.valuePtr(), progress) ? 1 : 0; });
    if (std::count(sound.begin(), sound.end(), 0) > 1) return false;
    return run(tasks_.size() - 1, lower.valuePtr(), progress);
}

bool MultifrontalLdlt::run(std::size_t t, const double* matrix, const Progress& progress) {
    Task& task = tasks_[t];
    task.top = 0;
    for (const Index f : task.fronts) {
        progress.check();
        const Front& front = fronts_[at(f)];
        double* schur = task.stack.data() + task.top;
        assemble(front, matrix, schur, task);
        const Panel panel{values_.data() + front.panel, front.height(), front.width()};
        if (!factor_panel(panel, task.buffers)) return false;
        subtract_outer_product(panel, schur, task.buffers);
        // The update takes the place of the children's, which are the last on the stack.
        for (const Index c : front.children) {
            if (task_of_[at(c)] == t) task.top -= update_size(c);
        }
        double* room = task.stack.data() + task.top;
        for (std::size_t j = 0; j < front.rows; ++j) {  // its lower triangle
            const std::size_t first = j * front.rows + j;
            std::copy_n(schur + first, front.rows - j, room + first);
        }
        updates_[at(f)] = room;
        task.top += update_size(f);
    }
    return true;
}

/// The front's panel, and the rest of it in `schur`: entries of the matrix and the children's
/// updates.
void MultifrontalLdlt::assemble(const Front& front, const double* matrix, double* schur,
                                Task& task) {
    double* panel = values_.data() + front.panel;
    const std::size_t height = front.height();
    std::fill_n(panel, height * front.width(), 0.0);
    for (std::size_t j = 0; j < front.rows; ++j)
        std::fill_n(schur + j * front.rows + j, front.rows - j, 0.0);
    for (std::size_t e = front.entries_begin; e < front.entries_end; ++e) {
        const Entry& entry = entries_[e];
        panel[at(entry.column) * height + at(entry.row)] += matrix[entry.from];
    }
    for (const Index c : front.children) {
        add_update(fronts_[at(c)], updates_[at(c)], front, schur, task.slots);
    }
}

void MultifrontalLdlt::add_update(const Front& child, const double* update, const Front& front,
                                  double* schur, std::vector<Index>& slots) {
    slots.resize(child.rows);
    const Index* rows = rows_.data() + front.rows_begin;
    Index next = 0;
    for (std::size_t i = 0; i < child.rows; ++i) {
        const Index position = rows_[child.rows_begin + i];
        if (position < front.first + front.columns) {
            slots[i] = position - front.first;
        } else {
            while (rows[next] != position) ++next;
            slots[i] = front.columns + next;
        }
    }
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
    for (const Front& front : fronts_) {
        for (std::size_t j = 0; j < front.width(); ++j) {
            if (values_[front.panel + j * front.height() + j] < 0.0) ++negative;
        }
    }
    return negative;
}

Eigen::VectorXd MultifrontalLdlt::solve(const Eigen::VectorXd& right_hand_side) const {
    Eigen::VectorXd x(right_hand_side.size()), rest;
    for (std::size_t i = 0; i < position_.size(); ++i)
        x[position_[i]] = right_hand_side[static_cast<Eigen::Index>(i)];
    const auto panel_of = [&](const Front& front) {
        return ConstPanel(values_.data() + front.panel, static_cast<Eigen::Index>(front.height()),
                          front.columns);
    };
    for (const Front& front : fronts_) {
        const auto panel = panel_of(front);
        auto own = x.segment(front.first, front.columns);
        panel.topRows(front.columns).triangularView<Eigen::UnitLower>().solveInPlace(own);
        rest.noalias() = panel.bottomRows(static_cast<Eigen::Index>(front.rows)) * own;
        for (std::size_t i = 0; i < front.rows; ++i)
            x[rows_[front.rows_begin + i]] -= rest[static_cast<Eigen::Index>(i)];
        own.array() /= panel.diagonal().array();
    }
    for (auto front = fronts_.rbegin(); front != fronts_.rend(); ++front) {
        const auto panel = panel_of(*front);
        auto own = x.segment(front->first, front->columns);
        rest.resize(static_cast<Eigen::Index>(front->rows));
        for (std::size_t i = 0; i < front->rows; ++i)
            rest[static_cast<Eigen::Index>(i)] = x[rows_[front->rows_begin + i]];
        own.noalias() -=
            panel.bottomRows(static_cast<Eigen::Index>(front->rows)).transpose() * rest;
        panel.topRows(front->columns)
            .triangularView<Eigen::UnitLower>()
            .transpose()
            .solveInPlace(own);
    }
    Eigen::VectorXd result(x.size());
    for (std::size_t i = 0; i < position_.size(); ++i)
        result[static_cast<Eigen::Index>(i)] = x[position_[i]];
    return result;
}

}  // namespace lastflat
