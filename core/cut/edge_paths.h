// Shortest paths along the edges of a region.
#pragma once

#include <limits>
#include <vector>

#include "core/cut/region.h"

namespace lastflat {

/// Dijkstra's shortest paths from the nearest of some vertices, as far as `reach`, mm.
class EdgePaths {
public:
    EdgePaths(const Region& region, const std::vector<Index>& from,
              double reach = std::numeric_limits<double>::infinity());

    [[nodiscard]] double distance(Index v) const { return distance_[static_cast<std::size_t>(v)]; }
    [[nodiscard]] bool reaches(Index v) const {
        return distance(v) < std::numeric_limits<double>::infinity();
    }
    /// The nearest vertex for which it is true; -1 if none is reached.
    template <class Choice>
    [[nodiscard]] Index nearest(const Choice& choice) const {
        Index best = -1;
        for (Index v = 0; v < static_cast<Index>(distance_.size()); ++v) {
            if (reaches(v) && choice(v) && (best < 0 || distance(v) < distance(best))) best = v;
        }
        return best;
    }
    /// The way to a vertex that is reached, both ends included.
    [[nodiscard]] std::vector<Index> to(Index v) const;

private:
    std::vector<double> distance_;
    std::vector<Index> before_;  ///< on the way to each vertex; -1: it begins there
};

}  // namespace lastflat
