#include "core/weld/merge_vertices.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <tuple>

#include "core/numerics/disjoint_sets.h"

namespace lastflat {

std::vector<Index> each_for_itself(std::size_t count) {
    std::vector<Index> ids(count);
    std::iota(ids.begin(), ids.end(), 0);
    return ids;
}

namespace {

using Cell = std::array<std::int64_t, 3>;

/// Vertices by cell, and where the cells' vertices begin; both ascending.
struct Grid {
    struct Placed {
        Cell cell;
        Index vertex;
    };
    std::vector<Placed> vertices;
    std::vector<std::size_t> firsts;  ///< per cell, and the end

    [[nodiscard]] std::size_t cells() const { return firsts.size() - 1; }
    [[nodiscard]] const Cell& cell(std::size_t i) const { return vertices[firsts[i]].cell; }
    [[nodiscard]] std::span<const Placed> of_cell(std::size_t i) const {
        return {&vertices[firsts[i]], firsts[i + 1] - firsts[i]};
    }
};

/// Cells so small that all vertices of one are within the tolerance of each other.
Grid make_grid(const Points3& positions, double tolerance) {
    const double side = tolerance / std::sqrt(3.0);
    Grid grid;
    grid.vertices.reserve(positions.size());
    for (const Vec3& p : positions) {
        grid.vertices.push_back(
            {{std::llround(std::floor(p.x() / side)), std::llround(std::floor(p.y() / side)),
              std::llround(std::floor(p.z() / side))},
             static_cast<Index>(grid.vertices.size())});
    }
    std::sort(grid.vertices.begin(), grid.vertices.end(), [](const auto& a, const auto& b) {
        return std::tie(a.cell, a.vertex) < std::tie(b.cell, b.vertex);
    });
    for (std::size_t i = 0; i < grid.vertices.size(); ++i) {
        if (i == 0 || grid.vertices[i].cell != grid.vertices[i - 1].cell) grid.firsts.push_back(i);
    }
    grid.firsts.push_back(grid.vertices.size());
    return grid;
}

/// Joins the two cells' sets if any two of their vertices are within the tolerance. Each cell is
/// one set already, so the first such pair is enough.
void join_cells(const Points3& positions, double tolerance, std::span<const Grid::Placed> a,
                std::span<const Grid::Placed> b, DisjointSets& sets) {
    if (sets.find(a.front().vertex) == sets.find(b.front().vertex)) return;
    std::size_t looked_at = 0;
    constexpr std::size_t enough = 4096;  // of pairs: denser cells than 64 x 64 are no surface
    for (const auto& i : a) {
        for (const auto& j : b) {
            const double distance = (positions[at(i.vertex)] - positions[at(j.vertex)]).norm();
            if (distance <= tolerance) return sets.join(i.vertex, j.vertex);
            if (++looked_at > enough) return;
        }
    }
}

/// Joins each cell with the one that lies beside it by the given way.
void join_along(const Points3& positions, double tolerance, const Grid& grid, const Cell& way,
                DisjointSets& sets) {
    std::size_t there = 0;
    for (std::size_t here = 0; here < grid.cells(); ++here) {
        const Cell& from = grid.cell(here);
        const Cell wanted{from[0] + way[0], from[1] + way[1], from[2] + way[2]};
        while (there < grid.cells() && grid.cell(there) < wanted) ++there;
        if (there == grid.cells()) return;
        if (grid.cell(there) == wanted)
            join_cells(positions, tolerance, grid.of_cell(here), grid.of_cell(there), sets);
    }
}

void merge_within(const Points3& positions, double tolerance, DisjointSets& sets) {
    const Grid grid = make_grid(positions, tolerance);
    for (std::size_t i = 0; i < grid.cells(); ++i) {
        for (const auto& other : grid.of_cell(i))
            sets.join(grid.of_cell(i).front().vertex, other.vertex);
    }
    for (std::int64_t k = 63; k < 125; ++k)  // two cells reach as far as the tolerance
        join_along(positions, tolerance, grid, {k / 25 - 2, k / 5 % 5 - 2, k % 5 - 2}, sets);
}

/// Per vertex, the first of those at its position.
std::vector<Index> first_of_equal(const Points3& positions) {
    constexpr Index none = -1;
    std::size_t slots = 16;
    while (slots < 2 * positions.size()) slots *= 2;
    std::vector<Index> table(slots, none);  // open addressing
    const auto slot_of = [&](const Vec3& p) {
        std::uint64_t hash = 0;
        for (const double coordinate : p) {
            hash ^= std::bit_cast<std::uint64_t>(coordinate + 0.0);  // -0 is 0
            hash *= 0x9e3779b97f4a7c15u;
            hash ^= hash >> 32;
        }
        return static_cast<std::size_t>(hash) & (slots - 1);
    };
    std::vector<Index> first(positions.size());
    for (std::size_t v = 0; v < positions.size(); ++v) {
        std::size_t slot = slot_of(positions[v]);
        while (table[slot] != none && positions[at(table[slot])] != positions[v])
            slot = (slot + 1) & (slots - 1);
        if (table[slot] == none) table[slot] = static_cast<Index>(v);
        first[v] = table[slot];
    }
    return first;
}

}  // namespace

std::vector<Index> merge_vertices(const Points3& positions, double tolerance_mm) {
    std::vector<Index> result = first_of_equal(positions);
    if (tolerance_mm <= 0.0) return result;
    std::vector<Index> different;  // a vertex for every position
    Points3 places;
    std::vector<Index> number(positions.size());
    for (std::size_t v = 0; v < positions.size(); ++v) {
        if (result[v] == static_cast<Index>(v)) {
            number[v] = static_cast<Index>(different.size());
            different.push_back(result[v]);
            places.push_back(positions[v]);
        }
    }
    DisjointSets sets(places.size());
    merge_within(places, tolerance_mm, sets);
    for (Index& id : result) id = different[at(sets.find(number[at(id)]))];
    return result;
}

}  // namespace lastflat
