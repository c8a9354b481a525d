#include "core/cut/curve_runs.h"

#include <algorithm>

namespace lastflat {
namespace {

struct Edge {
    Index from, to;  ///< region vertices
};

/// The region's edges, filed under the sources of their ends.
class EdgesBySource {
public:
    explicit EdgesBySource(const Region& region) {
        for (const Triangle& t : region.triangles) {
            for (std::size_t i = 0; i < 3; ++i) {
                add(region, t[i], t[(i + 1) % 3]);
                add(region, t[(i + 1) % 3], t[i]);
            }
        }
        std::sort(entries_.begin(), entries_.end());
        entries_.erase(std::unique(entries_.begin(), entries_.end()), entries_.end());
    }

    /// All edges of the region from a vertex of source `a` to one of source `b`.
    [[nodiscard]] std::vector<Edge> between(Index a, Index b) const {
        std::vector<Edge> found;
        auto entry = std::lower_bound(entries_.begin(), entries_.end(), Entry{a, b, -1, -1});
        for (; entry != entries_.end() && (*entry)[0] == a && (*entry)[1] == b; ++entry) {
            found.push_back({(*entry)[2], (*entry)[3]});
        }
        return found;
    }

private:
    using Entry = std::array<Index, 4>;
    void add(const Region& region, Index from, Index to) {
        entries_.push_back({region.source_vertices[static_cast<std::size_t>(from)],
                            region.source_vertices[static_cast<std::size_t>(to)], from, to});
    }
    std::vector<Entry> entries_;
};

/// Appends the edge to the run that ends where it begins, or opens a new run.
void append(std::vector<CurveRun>& open, const std::string& name, const Edge& edge,
            std::vector<bool>& extended) {
    for (std::size_t i = 0; i < open.size(); ++i) {
        if (!extended[i] && open[i].vertices.back() == edge.from) {
            open[i].vertices.push_back(edge.to);
            extended[i] = true;
            return;
        }
    }
    open.push_back({name, {edge.from, edge.to}});
    extended.push_back(true);
}

/// A closed curve may begin in the middle of a run: its last run then goes on as its first.
void join_ends(const Curve& curve, std::vector<CurveRun>& runs) {
    if (!curve.closed()) return;
    for (std::size_t last = runs.size(); last-- > 1;) {
        for (std::size_t first = 0; first < last; ++first) {
            if (runs[last].vertices.back() != runs[first].vertices.front()) continue;
            runs[last].vertices.insert(runs[last].vertices.end(), runs[first].vertices.begin() + 1,
                                       runs[first].vertices.end());
            runs[first] = std::move(runs[last]);
            runs.erase(runs.begin() + static_cast<std::ptrdiff_t>(last));
            break;
        }
    }
}

std::vector<CurveRun> runs_of(const Curve& curve, const EdgesBySource& edges) {
    std::vector<CurveRun> done, open;
    for (std::size_t i = 1; i < curve.vertices.size(); ++i) {
        std::vector<bool> extended(open.size(), false);
        for (const Edge& edge : edges.between(curve.vertices[i - 1], curve.vertices[i])) {
            append(open, curve.name, edge, extended);
        }
        std::vector<CurveRun> still_open;
        for (std::size_t k = 0; k < open.size(); ++k) {
            (extended[k] ? still_open : done).push_back(std::move(open[k]));
        }
        open = std::move(still_open);
    }
    std::move(open.begin(), open.end(), std::back_inserter(done));
    join_ends(curve, done);
    return done;
}

}  // namespace

std::vector<CurveRun> curve_runs(const Region& region, const Curves& curves) {
    const EdgesBySource edges(region);
    std::vector<CurveRun> runs;
    for (const Curve& curve : curves) {
        auto found = runs_of(curve, edges);
        std::move(found.begin(), found.end(), std::back_inserter(runs));
    }
    return runs;
}

}  // namespace lastflat
