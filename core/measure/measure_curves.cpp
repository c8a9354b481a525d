#include <algorithm>
#include <cmath>

#include "core/measure/report.h"
#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

struct Lengths {
    double in_space = 0.0, flat = 0.0, worst_edge = 0.0, worst_edge_relative = 0.0;
};

Lengths lengths_of(const Region& region, const Points2& uv, const CurveRun& run) {
    Lengths sum;
    for (std::size_t i = 1; i < run.vertices.size(); ++i) {
        const double in_space = region.distance(run.vertices[i - 1], run.vertices[i]);
        const double flat = (uv[static_cast<std::size_t>(run.vertices[i])] -
                             uv[static_cast<std::size_t>(run.vertices[i - 1])])
                                .norm();
        sum.in_space += in_space;
        sum.flat += flat;
        const double error = std::abs(flat - in_space);
        sum.worst_edge = std::max(sum.worst_edge, error);
        sum.worst_edge_relative = std::max(sum.worst_edge_relative, error / in_space);
    }
    return sum;
}

Verdict graded(double value, double pass, double warn) {
    return value <= pass ? Verdict::pass : value <= warn ? Verdict::warn : Verdict::fail;
}

/// Locked: kept or not. The topline gapes by millimetres; every other edge is lasted and may be
/// pleated by a share of its length.
Verdict verdict_on(const std::string& curve, const Constraint* lock, const Lengths& lengths) {
    const double error = std::abs(lengths.flat - lengths.in_space);
    if (lock != nullptr) {
        const double relative =
            lock->keep == Keep::edges ? lengths.worst_edge_relative : error / lengths.in_space;
        return relative <= tolerance::locked_length ? Verdict::pass : Verdict::fail;
    }
    if (curve == "topline") return graded(error, 0.5, 1.5);
    return graded(error / lengths.in_space, 0.01, 0.02);
}

const Constraint* lock_on(const std::string& curve, const std::string& region,
                          const std::vector<Constraint>& constraints) {
    const auto found =
        std::find_if(constraints.begin(), constraints.end(), [&](const Constraint& c) {
            return c.kind == ConstraintKind::lock && c.curve == curve &&
                   (c.region.empty() || c.region == region);
        });
    return found == constraints.end() ? nullptr : &*found;
}

/// The run's vertices of the last, in the direction that is the smaller of the two.
std::vector<Index> sources_of(const Region& region, const CurveRun& run) {
    std::vector<Index> sources;
    for (const Index v : run.vertices) {
        sources.push_back(region.source_vertices[static_cast<std::size_t>(v)]);
    }
    std::vector<Index> reversed(sources.rbegin(), sources.rend());
    return std::min(sources, reversed);
}

}  // namespace

std::vector<CurveReport> measure_curves(const Region& region, const Points2& uv,
                                        const std::vector<Constraint>& constraints) {
    std::vector<CurveReport> reports;
    for (const CurveRun& run : region.runs) {
        const Lengths lengths = lengths_of(region, uv, run);
        const Constraint* lock = lock_on(run.curve, region.name, constraints);
        reports.push_back({run.curve, lock != nullptr, lengths.in_space, lengths.flat,
                           lengths.flat - lengths.in_space, lengths.worst_edge,
                           verdict_on(run.curve, lock, lengths)});
    }
    return reports;
}

std::vector<PairReport> measure_pairs(const std::vector<Region>& regions,
                                      const std::vector<Chart>& charts) {
    struct Side {
        std::size_t region;
        const CurveRun* run;
        std::vector<Index> sources;
    };
    std::vector<Side> sides;
    for (std::size_t r = 0; r < regions.size(); ++r) {
        for (const CurveRun& run : regions[r].runs)
            sides.push_back({r, &run, sources_of(regions[r], run)});
    }
    std::vector<PairReport> pairs;
    for (std::size_t i = 0; i < sides.size(); ++i) {
        for (std::size_t j = i + 1; j < sides.size(); ++j) {
            const Side &a = sides[i], &b = sides[j];
            if (a.run->curve != b.run->curve || a.sources != b.sources) continue;
            const double difference =
                lengths_of(regions[a.region], charts[a.region].uv, *a.run).flat -
                lengths_of(regions[b.region], charts[b.region].uv, *b.run).flat;
            pairs.push_back(
                {a.run->curve, regions[a.region].name, regions[b.region].name, difference,
                 std::abs(difference) <= tolerance::pair_difference_mm ? Verdict::pass
                                                                       : Verdict::fail});
        }
    }
    return pairs;
}

}  // namespace lastflat
