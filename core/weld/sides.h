// The sides of triangles, filed under their edges.
#pragma once

#include <vector>

#include "core/numerics/disjoint_sets.h"
#include "core/numerics/types.h"

namespace lastflat {

/// One side of a triangle: it runs from the triangle's corner `corner` to the next.
struct Side {
    Index low, high;  ///< the edge's vertices
    Index triangle;
    Index corner;
    bool forward;  ///< runs from low to high

    [[nodiscard]] bool same_edge(const Side& other) const {
        return low == other.low && high == other.high;
    }
    [[nodiscard]] Index from() const { return forward ? low : high; }
    [[nodiscard]] Index to() const { return forward ? high : low; }
};

/// Sorted by edge, then by triangle.
[[nodiscard]] std::vector<Side> sides_by_edge(const std::vector<Triangle>& triangles);

/// Triangles that hang together over edges of two that wind alike.
[[nodiscard]] DisjointSets patches_of(const std::vector<Triangle>& triangles,
                                      const std::vector<Side>& sides);

/// Calls visit(first, last) for every edge with its range of sides.
template <class Visit>
void for_each_edge(const std::vector<Side>& sides, const Visit& visit) {
    for (auto first = sides.begin(); first != sides.end();) {
        auto last = first + 1;
        while (last != sides.end() && last->same_edge(*first)) ++last;
        visit(first, last);
        first = last;
    }
}

}  // namespace lastflat
