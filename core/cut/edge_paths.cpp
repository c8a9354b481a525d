#include "core/cut/edge_paths.h"

#include <algorithm>
#include <queue>

namespace lastflat {

EdgePaths::EdgePaths(const Region& region, const std::vector<Index>& from, double reach)
    : distance_(region.positions.size(), std::numeric_limits<double>::infinity()),
      before_(region.positions.size(), -1) {
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (const Index v : from) {
        distance_[static_cast<std::size_t>(v)] = 0.0;
        queue.emplace(0.0, v);
    }
    while (!queue.empty()) {
        const auto [so_far, v] = queue.top();
        queue.pop();
        if (so_far > distance(v)) continue;
        for (const Index next : region.half_edges.ring(v)) {
            const double way = so_far + region.distance(v, next);
            if (way >= distance(next) || way > reach) continue;
            distance_[static_cast<std::size_t>(next)] = way;
            before_[static_cast<std::size_t>(next)] = v;
            queue.emplace(way, next);
        }
    }
}

std::vector<Index> EdgePaths::to(Index v) const {
    std::vector<Index> path;
    for (; v >= 0; v = before_[static_cast<std::size_t>(v)]) path.push_back(v);
    std::reverse(path.begin(), path.end());
    return path;
}

}  // namespace lastflat
