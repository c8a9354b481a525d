// Based on: Duff, Reid, "The Multifrontal Solution of Indefinite Sparse Symmetric Linear
// Equations", ACM TOMS 1983; Liu, "The Multifrontal Method for Sparse Matrix Solution: Theory and
// Practice", SIAM Review 1992.
#include "core/numerics/front_tree.h"

#include <algorithm>

namespace lastflat {
namespace {

/// Multiplications that a front takes, about.
double work_of(double columns, double height) {
    return columns * height * height;
}

}  // namespace

void FrontTree::analyse(const SparseMatrix& lower, const std::vector<UnknownBlock>& blocks) {
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
    panels_size_ = 0;
    for (Front& front : fronts_) {
        front.panel = panels_size_;
        panels_size_ += front.height() * front.width();
    }
}

/// Entries by front, with the positions of their unknowns as row and column for now.
void FrontTree::sort_entries(const SparseMatrix& lower) {
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
void FrontTree::find_rows() {
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
void FrontTree::choose_tasks() {
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
    for (std::size_t t = 0; t < tasks_.size(); ++t) measure_stack(tasks_[t], t);
}

void FrontTree::measure_stack(Task& task, std::size_t t) const {
    std::size_t top = 0;
    for (const Index f : task.fronts) {
        top += update_size(f);
        task.stack = std::max(task.stack, top);
        for (const Index c : fronts_[at(f)].children) {
            if (task_of(c) == t) top -= update_size(c);
        }
    }
}

void FrontTree::find_slots(const Front& child, const Front& parent,
                           std::vector<Index>& slots) const {
    slots.resize(child.rows);
    const Index* rows = rows_.data() + parent.rows_begin;
    Index next = 0;
    for (std::size_t i = 0; i < child.rows; ++i) {
        const Index position = row(child, i);
        if (position < parent.first + parent.columns) {
            slots[i] = position - parent.first;
        } else {
            while (rows[next] != position) ++next;
            slots[i] = parent.columns + next;
        }
    }
}

}  // namespace lastflat
