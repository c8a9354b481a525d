#include "core/cut/curve_runs.h"

#include <algorithm>

namespace lastflat {
namespace {

struct Edge {
    Index from, to;  ///< region vertices
};

/// All edges of the region from a vertex of source `a` to one of source `b`, ascending.
std::vector<Edge> edges_between(const Region& region, Index a, Index b) {
    const auto& sources = region.source_vertices;
    const auto [first, last] = std::equal_range(sources.begin(), sources.end(), a);
    std::vector<Edge> found;
    for (auto source = first; source != last; ++source) {
        const auto from = static_cast<Index>(source - sources.begin());
        auto ring = region.half_edges.ring(from);
        std::sort(ring.begin(), ring.end());
        for (const Index to : ring) {
            if (sources[at(to)] == b) found.push_back({from, to});
        }
    }
    return found;
}

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

std::vector<CurveRun> runs_of(const Region& region, const Curve& curve) {
    std::vector<CurveRun> done, open;
    for (std::size_t i = 1; i < curve.vertices.size(); ++i) {
        std::vector<bool> extended(open.size(), false);
        for (const Edge& edge : edges_between(region, curve.vertices[i - 1], curve.vertices[i])) {
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
    std::vector<CurveRun> runs;
    for (const Curve& curve : curves) {
        auto found = runs_of(region, curve);
        std::move(found.begin(), found.end(), std::back_inserter(runs));
    }
    return runs;
}

}  // namespace lastflat
