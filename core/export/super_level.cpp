#include "core/export/super_level.h"

#include <map>

namespace lastflat {
namespace {

/// A vertex (twice), or where the level crosses an edge (its ends, the smaller id first).
using Node = std::pair<Index, Index>;

class Tracer {
public:
    Tracer(const Region& region, const Points2& positions, const std::vector<double>& values,
           double level)
        : region_(region), positions_(positions), values_(values), level_(level) {}

    std::vector<Points2> loops() {
        for (const Triangle& t : region_.triangles) link_across(t);
        for (const std::vector<Index>& loop : border_loops(region_)) link_along(loop);
        std::vector<Points2> loops;
        while (!next_.empty()) {
            loops.emplace_back();
            for (auto step = next_.begin(); step != next_.end();) {
                loops.back().push_back(position(step->first));
                const Node to = step->second;
                next_.erase(step);
                step = next_.find(to);
            }
        }
        return loops;
    }

private:
    [[nodiscard]] bool is_in(Index v) const { return values_[at(v)] >= level_; }
    static Node crossing(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

    [[nodiscard]] Vec2 position(const Node& node) const {
        const auto& [a, b] = node;
        if (a == b) return positions_[at(a)];
        const double share = (level_ - values_[at(a)]) / (values_[at(b)] - values_[at(a)]);
        return positions_[at(a)] + share * (positions_[at(b)] - positions_[at(a)]);
    }

    /// From the side over which the triangle's border leaves the place to the one over which it
    /// comes back.
    void link_across(const Triangle& t) {
        Node leaves{-1, -1}, comes{-1, -1};
        for (std::size_t i = 0; i < 3; ++i) {
            const Index a = t[i], b = t[(i + 1) % 3];
            if (is_in(a) && !is_in(b)) leaves = crossing(a, b);
            if (!is_in(a) && is_in(b)) comes = crossing(a, b);
        }
        if (leaves.first >= 0) next_.emplace(leaves, comes);
    }

    /// The parts of a border loop that lie in the place.
    void link_along(const std::vector<Index>& loop) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Index v = loop[i], w = loop[(i + 1) % loop.size()];
            if (is_in(v))
                next_.emplace(Node{v, v}, is_in(w) ? Node{w, w} : crossing(v, w));
            else if (is_in(w))
                next_.emplace(crossing(v, w), Node{w, w});
        }
    }

    const Region& region_;
    const Points2& positions_;
    const std::vector<double>& values_;
    const double level_;
    std::map<Node, Node> next_;
};

}  // namespace

std::vector<Points2> super_level_loops(const Region& region, const Points2& positions,
                                       const std::vector<double>& values, double level) {
    return Tracer(region, positions, values, level).loops();
}

}  // namespace lastflat
