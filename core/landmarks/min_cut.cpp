#include "core/landmarks/min_cut.h"

#include <algorithm>
#include <limits>

#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

/// Dinic's algorithm: shortest augmenting paths, level by level.
class Flow {
public:
    Flow(const std::vector<GraphEdge>& edges, const std::vector<Side2>& nodes)
        : source_(nodes.size()), sink_(nodes.size() + 1), arcs_(nodes.size() + 2) {
        double total = 1.0;
        for (const GraphEdge& edge : edges) {
            add(static_cast<std::size_t>(edge.a), static_cast<std::size_t>(edge.b), edge.weight,
                edge.weight);
            total += edge.weight;
        }
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            if (nodes[n] == Side2::first) add(source_, n, total, 0.0);
            if (nodes[n] == Side2::second) add(n, sink_, total, 0.0);
        }
        round_off_ = tolerance::used_up * total;
    }

    /// Per node, whether it is still reached from the first side.
    std::vector<bool> part() {
        while (find_levels()) {
            next_.assign(arcs_.size(), 0);
            while (augment()) {
            }
        }
        std::vector<bool> reached;
        for (std::size_t n = 0; n + 2 < arcs_.size(); ++n) reached.push_back(level_[n] >= 0);
        return reached;
    }

private:
    struct Arc {
        std::size_t to, back;
        double room;
    };

    void add(std::size_t a, std::size_t b, double there, double back) {
        arcs_[a].push_back({b, arcs_[b].size(), there});
        arcs_[b].push_back({a, arcs_[a].size() - 1, back});
    }

    bool find_levels() {
        level_.assign(arcs_.size(), -1);
        level_[source_] = 0;
        std::vector<std::size_t> queue{source_};
        for (std::size_t i = 0; i < queue.size(); ++i) {
            for (const Arc& arc : arcs_[queue[i]]) {
                if (arc.room <= round_off_ || level_[arc.to] >= 0) continue;
                level_[arc.to] = level_[queue[i]] + 1;
                queue.push_back(arc.to);
            }
        }
        return level_[sink_] >= 0;
    }

    /// Fills one path of the level graph; false: there is none left.
    bool augment() {
        std::vector<std::pair<std::size_t, std::size_t>> path;  // node, arc
        std::size_t at = source_;
        while (at != sink_) {
            bool further = false;
            for (std::size_t& i = next_[at]; i < arcs_[at].size(); ++i) {
                const Arc& arc = arcs_[at][i];
                if (arc.room <= round_off_ || level_[arc.to] != level_[at] + 1) continue;
                path.emplace_back(at, i);
                at = arc.to;
                further = true;
                break;
            }
            if (further) continue;
            if (path.empty()) return false;
            at = path.back().first;  // a dead end: its arc is done with
            ++next_[at];
            path.pop_back();
        }
        double room = std::numeric_limits<double>::infinity();
        for (const auto& [node, i] : path) room = std::min(room, arcs_[node][i].room);
        for (const auto& [node, i] : path) {
            Arc& arc = arcs_[node][i];
            arc.room -= room;
            arcs_[arc.to][arc.back].room += room;
        }
        return true;
    }

    const std::size_t source_, sink_;
    std::vector<std::vector<Arc>> arcs_;
    std::vector<int> level_;
    std::vector<std::size_t> next_;
    double round_off_;
};

}  // namespace

std::vector<bool> minimum_cut(const std::vector<GraphEdge>& edges,
                              const std::vector<Side2>& nodes) {
    return Flow(edges, nodes).part();
}

}  // namespace lastflat
