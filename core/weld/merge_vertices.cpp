#include "core/weld/merge_vertices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/numerics/disjoint_sets.h"

namespace lastflat {

std::vector<Index> each_for_itself(std::size_t count) {
    std::vector<Index> ids(count);
    std::iota(ids.begin(), ids.end(), 0);
    return ids;
}

namespace {

using Cell = std::array<std::int64_t, 3>;

bool before(const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

/// Vertices sorted by cell; those of one cell stand together.
struct Grid {
    std::vector<Cell> cells;   ///< per vertex
    std::vector<Index> order;  ///< vertices by cell, then by id

    [[nodiscard]] const Cell& cell(Index v) const { return cells[static_cast<std::size_t>(v)]; }
    [[nodiscard]] auto range(const Cell& wanted) const {
        const auto first = std::lower_bound(order.begin(), order.end(), wanted,
                                            [&](Index v, const Cell& c) { return cell(v) < c; });
        const auto last = std::upper_bound(first, order.end(), wanted,
                                           [&](const Cell& c, Index v) { return c < cell(v); });
        return std::pair(first, last);
    }
};

/// Cells so small that all vertices of one are within the tolerance of each other.
Grid make_grid(const Points3& positions, double tolerance) {
    const double side = tolerance / std::sqrt(3.0);
    Grid grid;
    for (const Vec3& p : positions) {
        grid.cells.push_back({std::llround(std::floor(p.x() / side)),
                              std::llround(std::floor(p.y() / side)),
                              std::llround(std::floor(p.z() / side))});
    }
    grid.order = each_for_itself(positions.size());
    std::stable_sort(grid.order.begin(), grid.order.end(),
                     [&](Index a, Index b) { return grid.cell(a) < grid.cell(b); });
    return grid;
}

/// Joins the two cells' sets if any two of their vertices are within the tolerance. Each cell is
/// one set already, so the first such pair is enough.
void join_cells(const Points3& positions, double tolerance, const Grid& grid, const Cell& a,
                const Cell& b, DisjointSets& sets) {
    const auto [a_first, a_last] = grid.range(a);
    const auto [b_first, b_last] = grid.range(b);
    if (a_first == a_last || b_first == b_last || sets.find(*a_first) == sets.find(*b_first))
        return;
    std::size_t looked_at = 0;
    constexpr std::size_t enough = 4096;  // of pairs: denser cells than 64 x 64 are no surface
    for (auto i = a_first; i != a_last; ++i) {
        for (auto j = b_first; j != b_last; ++j) {
            const auto distance =
                (positions[static_cast<std::size_t>(*i)] - positions[static_cast<std::size_t>(*j)])
                    .norm();
            if (distance <= tolerance) return sets.join(*i, *j);
            if (++looked_at > enough) return;
        }
    }
}

void merge_within(const Points3& positions, double tolerance, DisjointSets& sets) {
    const Grid grid = make_grid(positions, tolerance);
    for (std::size_t i = 1; i < grid.order.size(); ++i) {
        if (grid.cell(grid.order[i]) == grid.cell(grid.order[i - 1])) {
            sets.join(grid.order[i], grid.order[i - 1]);
        }
    }
    for (std::size_t i = 0; i < grid.order.size(); ++i) {
        const Cell& here = grid.cell(grid.order[i]);
        if (i > 0 && here == grid.cell(grid.order[i - 1])) continue;  // once a cell
        for (std::int64_t k = 0; k < 125; ++k) {  // two cells reach as far as the tolerance
            const Cell there{here[0] + k % 5 - 2, here[1] + k / 5 % 5 - 2, here[2] + k / 25 - 2};
            if (here < there) join_cells(positions, tolerance, grid, here, there, sets);
        }
    }
}

void merge_equal(const Points3& positions, DisjointSets& sets) {
    const auto at = [&](Index v) -> const Vec3& { return positions[static_cast<std::size_t>(v)]; };
    std::vector<Index> order = each_for_itself(positions.size());
    std::stable_sort(order.begin(), order.end(),
                     [&](Index a, Index b) { return before(at(a), at(b)); });
    for (std::size_t i = 1; i < order.size(); ++i) {
        if (at(order[i]) == at(order[i - 1])) sets.join(order[i], order[i - 1]);
    }
}

}  // namespace

std::vector<Index> merge_vertices(const Points3& positions, double tolerance_mm) {
    DisjointSets sets(positions.size());
    if (tolerance_mm > 0.0) {
        merge_within(positions, tolerance_mm, sets);
    } else {
        merge_equal(positions, sets);
    }
    std::vector<Index> result(positions.size());
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = sets.find(static_cast<Index>(i));
    return result;
}

}  // namespace lastflat
