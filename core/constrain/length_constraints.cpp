#include "core/constrain/length_constraints.h"

#include <algorithm>
#include <set>

namespace lastflat {
namespace {

using Edge = std::pair<Index, Index>;

std::vector<Edge> edges_of(const CurveRun& run) {
    std::vector<Edge> edges;
    for (std::size_t i = 1; i < run.vertices.size(); ++i) {
        edges.push_back(std::minmax(run.vertices[i - 1], run.vertices[i]));
    }
    return edges;
}

template <class Visit>
void for_locked_runs(const Region& region, const std::vector<Lock>& locks, Keep keep, Visit visit) {
    for (const Lock& lock : locks) {
        for (const CurveRun& run : region.runs) {
            if (run.curve == lock.curve && lock.keep == keep) visit(run);
        }
    }
}

}  // namespace

std::vector<LengthConstraint> length_constraints(const Region& region,
                                                 const std::vector<Lock>& locks) {
    std::vector<LengthConstraint> constraints;
    std::set<Edge> kept;
    for_locked_runs(region, locks, Keep::edges, [&](const CurveRun& run) {
        for (const Edge& edge : edges_of(run)) {
            if (!kept.insert(edge).second) continue;
            constraints.push_back({run.curve, {edge}, region.distance(edge.first, edge.second)});
        }
    });
    std::set<std::vector<Edge>> totals;
    for_locked_runs(region, locks, Keep::total, [&](const CurveRun& run) {
        auto edges = edges_of(run);
        std::sort(edges.begin(), edges.end());
        const bool implied = std::all_of(edges.begin(), edges.end(),
                                         [&](const Edge& edge) { return kept.count(edge) > 0; });
        if (implied || !totals.insert(edges).second) return;
        double length = 0.0;
        for (const Edge& edge : edges) length += region.distance(edge.first, edge.second);
        constraints.push_back({run.curve, std::move(edges), length});
    });
    return constraints;
}

std::vector<bool> locked_border_edges(const Region& region, const std::vector<Lock>& locks) {
    std::set<Edge> kept;
    for_locked_runs(region, locks, Keep::edges, [&](const CurveRun& run) {
        for (const Edge& edge : edges_of(run)) kept.insert(edge);
    });
    const std::size_t n = region.border.size();
    std::vector<bool> locked(n);
    for (std::size_t i = 0; i < n; ++i) {
        locked[i] = kept.count(std::minmax(region.border[i], region.border[(i + 1) % n])) > 0;
    }
    return locked;
}

double flat_length(const LengthConstraint& constraint, const Eigen::VectorXd& x) {
    double length = 0.0;
    for (const auto& [a, b] : constraint.edges) {
        length += (x.segment<2>(2 * a) - x.segment<2>(2 * b)).norm();
    }
    return length;
}

}  // namespace lastflat
