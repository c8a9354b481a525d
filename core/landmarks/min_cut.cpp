#include "core/landmarks/min_cut.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

/// Dinic's algorithm: shortest augmenting paths, level by level. What stays on a given side is one
/// node with it.
class Flow {
public:
    Flow(const std::vector<GraphEdge>& edges, const std::vector<Side2>& nodes) {
        for (const Side2 side : nodes)
            names_.push_back(side == Side2::first    ? source
                             : side == Side2::second ? sink
                                                     : count_++);
        first_.assign(count_ + 1, 0);
        double total = 0.0;
        for (const GraphEdge& edge : edges) {
            const std::size_t a = names_[at(edge.a)], b = names_[at(edge.b)];
            if (a == b) continue;
            ++first_[a + 1];
            ++first_[b + 1];
            total += edge.weight;
        }
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        arcs_.resize(first_.back());
        next_.assign(first_.begin(), first_.end() - 1);
        for (const GraphEdge& edge : edges) {
            const std::size_t a = names_[at(edge.a)], b = names_[at(edge.b)];
            if (a == b) continue;
            arcs_[next_[a]] = {b, next_[b], edge.weight};
            arcs_[next_[b]] = {a, next_[a], edge.weight};
            ++next_[a];
            ++next_[b];
        }
        round_off_ = tolerance::used_up * total;
    }

    /// Per node that was given, whether it is still reached from the first side.
    std::vector<bool> part() {
        while (find_levels()) {
            next_.assign(first_.begin(), first_.end() - 1);
            fill_paths();
        }
        std::vector<bool> reached;
        for (const std::size_t name : names_) reached.push_back(level_[name] >= 0);
        return reached;
    }

private:
    static constexpr std::size_t source = 0, sink = 1;
    struct Arc {
        std::size_t to, back;
        double room;
    };

    bool find_levels() {
        level_.assign(count_, -1);
        level_[source] = 0;
        queue_.assign(1, source);
        for (std::size_t i = 0; i < queue_.size(); ++i) {
            const std::size_t node = queue_[i];
            for (std::size_t a = first_[node]; a < first_[node + 1]; ++a) {
                const Arc& arc = arcs_[a];
                if (arc.room <= round_off_ || level_[arc.to] >= 0) continue;
                level_[arc.to] = level_[node] + 1;
                queue_.push_back(arc.to);
            }
        }
        return level_[sink] >= 0;
    }

    /// The arc by which a path goes on from a node in the level graph; `first_` of the next node:
    /// there is none.
    std::size_t way_on(std::size_t node) {
        std::size_t& a = next_[node];
        while (a < first_[node + 1] &&
               (arcs_[a].room <= round_off_ || level_[arcs_[a].to] != level_[node] + 1))
            ++a;
        return a;
    }

    /// Fills paths of the level graph until there is none left.
    void fill_paths() {
        std::vector<std::size_t> path;  // arcs
        for (;;) {
            const std::size_t node = path.empty() ? source : arcs_[path.back()].to;
            if (node == sink) {
                fill(path);
                continue;
            }
            const std::size_t a = way_on(node);
            if (a < first_[node + 1]) {
                path.push_back(a);
            } else if (path.empty()) {
                return;
            } else {  // a dead end: its arc is done with
                ++next_[arcs_[arcs_[path.back()].back].to];
                path.pop_back();
            }
        }
    }

    /// Fills a path, and takes it back to its first arc that is full.
    void fill(std::vector<std::size_t>& path) {
        double room = std::numeric_limits<double>::infinity();
        for (const std::size_t a : path) room = std::min(room, arcs_[a].room);
        std::size_t full = path.size();
        for (std::size_t i = path.size(); i-- > 0;) {
            Arc& arc = arcs_[path[i]];
            arc.room -= room;
            arcs_[arc.back].room += room;
            if (arc.room <= round_off_) full = i;
        }
        path.resize(full);
    }

    std::size_t count_ = 2;
    std::vector<std::size_t> names_;  ///< per node that was given, its own
    std::vector<std::size_t> first_;  ///< per node, its first arc
    std::vector<Arc> arcs_;
    std::vector<int> level_;
    std::vector<std::size_t> next_, queue_;
    double round_off_;
};

std::ptrdiff_t free_nodes(const std::vector<Side2>& nodes) {
    return std::count(nodes.begin(), nodes.end(), Side2::free);
}

/// Each free node in one with the free one to which its dearest edge leads, if that is not taken.
std::vector<Index> pairs_of(const std::vector<GraphEdge>& edges, const std::vector<Side2>& nodes) {
    std::vector<Index> order(edges.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](Index a, Index b) { return edges[at(a)].weight > edges[at(b)].weight; });
    std::vector<Index> partner(nodes.size(), -1);
    for (const Index e : order) {
        const auto& [a, b, weight] = edges[at(e)];
        if (a == b || nodes[at(a)] != Side2::free || nodes[at(b)] != Side2::free) continue;
        if (partner[at(a)] >= 0 || partner[at(b)] >= 0) continue;
        partner[at(a)] = b;
        partner[at(b)] = a;
    }
    return partner;
}

/// A graph in which pairs of nodes are one, and all that stays on a given side.
struct CoarseGraph {
    std::vector<Index> node_of;  ///< per node of the finer graph
    std::vector<Side2> nodes{Side2::first, Side2::second};
    std::vector<GraphEdge> edges{};  ///< one between two nodes, with the weight of all
};

std::vector<GraphEdge> merged(std::vector<GraphEdge> edges) {
    std::stable_sort(edges.begin(), edges.end(), [](const GraphEdge& p, const GraphEdge& q) {
        return std::pair(p.a, p.b) < std::pair(q.a, q.b);
    });
    std::size_t kept = 0;
    for (const GraphEdge& edge : edges) {
        if (kept > 0 && edges[kept - 1].a == edge.a && edges[kept - 1].b == edge.b)
            edges[kept - 1].weight += edge.weight;
        else
            edges[kept++] = edge;
    }
    edges.resize(kept);
    return edges;
}

CoarseGraph coarsened(const std::vector<GraphEdge>& edges, const std::vector<Side2>& nodes) {
    const auto partner = pairs_of(edges, nodes);
    CoarseGraph coarse{std::vector<Index>(nodes.size(), -1)};
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        if (nodes[n] != Side2::free) {
            coarse.node_of[n] = nodes[n] == Side2::first ? 0 : 1;
        } else if (partner[n] >= 0 && partner[n] < static_cast<Index>(n)) {
            coarse.node_of[n] = coarse.node_of[at(partner[n])];
        } else {
            coarse.node_of[n] = static_cast<Index>(coarse.nodes.size());
            coarse.nodes.push_back(Side2::free);
        }
    }
    std::vector<GraphEdge> between;
    for (const GraphEdge& edge : edges) {
        const auto [a, b] = std::minmax(coarse.node_of[at(edge.a)], coarse.node_of[at(edge.b)]);
        if (a != b) between.push_back({a, b, edge.weight});
    }
    coarse.edges = merged(std::move(between));
    return coarse;
}

/// The sides of the nodes by the cut of a coarser graph; those within some steps of it are free.
std::vector<Side2> coarsely_parted(const std::vector<GraphEdge>& edges,
                                   const std::vector<Side2>& nodes) {
    constexpr int steps = 8;
    constexpr double less = 0.9;  // free nodes, or it is as well to cut the graph itself
    const CoarseGraph coarse = coarsened(edges, nodes);
    if (static_cast<double>(free_nodes(coarse.nodes)) >
        less * static_cast<double>(free_nodes(nodes)))
        return nodes;
    const auto cut = minimum_cut(coarse.edges, coarse.nodes);
    const auto is_inside = [&](std::size_t n) {
        return static_cast<bool>(cut[at(coarse.node_of[n])]);
    };
    std::vector<bool> near(nodes.size(), false);
    for (int step = 0; step < steps; ++step) {
        const std::vector<bool> before = near;
        for (const auto& [a, b, weight] : edges) {
            if (before[at(a)] || before[at(b)] || is_inside(at(a)) != is_inside(at(b)))
                near[at(a)] = near[at(b)] = true;
        }
    }
    std::vector<Side2> sides = nodes;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        if (nodes[n] == Side2::free && !near[n])
            sides[n] = is_inside(n) ? Side2::first : Side2::second;
    }
    return sides;
}

}  // namespace

std::vector<bool> minimum_cut(const std::vector<GraphEdge>& edges,
                              const std::vector<Side2>& nodes) {
    constexpr std::ptrdiff_t most_at_once = 20'000;
    if (free_nodes(nodes) <= most_at_once) return Flow(edges, nodes).part();
    return Flow(edges, coarsely_parted(edges, nodes)).part();
}

}  // namespace lastflat
