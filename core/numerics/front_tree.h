// The fronts of a sparse system: what the factorizations of one symmetric pattern have in common.
#pragma once

#include <vector>

#include "core/numerics/types.h"

namespace lastflat {

/// Unknowns that are eliminated together; see `EliminationBlock`.
struct UnknownBlock {
    Index parent;
    std::vector<Index> unknowns;
};

/// Every block of unknowns is a small dense matrix, its front, that takes the updates of its
/// children and passes one on to its parent.
///
/// Paper: [duff-1983], [liu-1992].
class FrontTree {
public:
    struct Front {
        Index parent;
        Index first, columns;          ///< of its unknowns, in elimination order
        std::size_t rows_begin, rows;  ///< in `rows`: positions of later unknowns, ascending
        std::size_t panel;             ///< where `height() * width()` values begin
        std::size_t entries_begin, entries_end;  ///< in `entries`
        std::vector<Index> children;
        [[nodiscard]] std::size_t width() const { return static_cast<std::size_t>(columns); }
        [[nodiscard]] std::size_t height() const { return width() + rows; }
    };
    /// Where an entry of the matrix goes in its front.
    struct Entry {
        std::size_t from;
        Index row, column;
    };
    /// Fronts that one thread does, in this order.
    struct Task {
        std::vector<Index> fronts;
        std::size_t stack = 0;  ///< values that updates need that wait for their parents
    };

    /// `lower`: the lower triangle, compressed; only its pattern matters. `blocks`: every unknown
    /// once, children before parents; blocks of different branches share no entry.
    void analyse(const SparseMatrix& lower, const std::vector<UnknownBlock>& blocks);

    [[nodiscard]] const std::vector<Front>& fronts() const { return fronts_; }
    [[nodiscard]] const Front& front(Index f) const { return fronts_[at(f)]; }
    [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }
    /// Position of the front's row i in the elimination order.
    [[nodiscard]] Index row(const Front& front, std::size_t i) const {
        return rows_[front.rows_begin + i];
    }
    /// Per unknown, when it is eliminated.
    [[nodiscard]] const std::vector<Index>& positions() const { return position_; }
    /// Branches, independent of each other; the last: what lies above them.
    [[nodiscard]] const std::vector<Task>& tasks() const { return tasks_; }
    [[nodiscard]] std::size_t task_of(Index front) const { return task_of_[at(front)]; }
    [[nodiscard]] std::size_t panels_size() const { return panels_size_; }
    [[nodiscard]] std::size_t update_size(Index front) const {
        return fronts_[at(front)].rows * fronts_[at(front)].rows;
    }
    /// Per row of the child's update, its row in the parent's front.
    void find_slots(const Front& child, const Front& parent, std::vector<Index>& slots) const;

private:
    void sort_entries(const SparseMatrix& lower);
    void find_rows();
    void choose_tasks();
    void measure_stack(Task& task, std::size_t t) const;

    std::vector<Front> fronts_;
    std::vector<Index> position_, rows_;
    std::vector<Index> front_at_;  ///< per position, its front
    std::vector<Entry> entries_;   ///< front by front
    std::vector<Task> tasks_;
    std::vector<std::size_t> task_of_;  ///< per front
    std::size_t panels_size_ = 0;
};

}  // namespace lastflat
