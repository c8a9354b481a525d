#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "core/cut/seam_stretches.h"
#include "core/measure/report.h"
#include "core/numerics/tolerances.h"
#include "core/request.h"

namespace lastflat {
namespace {

struct Lengths {
    double in_space = 0.0, flat = 0.0, worst_edge = 0.0, worst_edge_relative = 0.0;
};

Lengths lengths_of(const Region& region, const Points2& uv, const std::vector<Index>& line) {
    Lengths sum;
    for (std::size_t i = 1; i < line.size(); ++i) {
        const double in_space = region.distance(line[i - 1], line[i]);
        const double flat =
            (uv[static_cast<std::size_t>(line[i])] - uv[static_cast<std::size_t>(line[i - 1])])
                .norm();
        sum.in_space += in_space;
        sum.flat += flat;
        const double error = std::abs(flat - in_space);
        sum.worst_edge = std::max(sum.worst_edge, error);
        sum.worst_edge_relative = std::max(sum.worst_edge_relative, error / in_space);
    }
    return sum;
}

std::optional<Verdict> verdict_on(const Lock* lock, const Lengths& lengths) {
    if (lock == nullptr) return std::nullopt;
    const double relative = lock->keep == Keep::edges
                                ? lengths.worst_edge_relative
                                : std::abs(lengths.flat - lengths.in_space) / lengths.in_space;
    return relative <= tolerance::locked_length ? Verdict::pass : Verdict::fail;
}

const Lock* lock_on(const std::string& curve, const std::string& region,
                    const std::vector<Constraint>& constraints) {
    for (const Constraint& constraint : constraints) {
        const Lock* lock = std::get_if<Lock>(&constraint.demand);
        if (lock != nullptr && lock->curve == curve &&
            (lock->region.empty() || lock->region == region))
            return lock;
    }
    return nullptr;
}

/// The whole of a curve in two regions, if it is longer on the last in one of them: a stretch of it
/// has no other side to be sewn to.
std::optional<PairReport> unequal_runs(const std::vector<Region>& regions,
                                       const std::vector<Chart>& charts, const std::string& curve) {
    std::map<std::size_t, Lengths> totals;
    for (std::size_t r = 0; r < regions.size(); ++r) {
        for (const CurveRun& run : regions[r].runs) {
            if (run.curve != curve) continue;
            const Lengths lengths = lengths_of(regions[r], charts[r].uv, run.vertices);
            totals[r].in_space += lengths.in_space;
            totals[r].flat += lengths.flat;
        }
    }
    if (totals.size() != 2) return std::nullopt;
    const auto& [a, in_a] = *totals.begin();
    const auto& [b, in_b] = *totals.rbegin();
    if (std::abs(in_a.in_space - in_b.in_space) <= tolerance::pair_difference_mm)
        return std::nullopt;
    return PairReport{curve,
                      regions[a].name,
                      regions[b].name,
                      std::max(in_a.in_space, in_b.in_space),
                      in_a.flat - in_b.flat,
                      Verdict::fail};
}

}  // namespace

std::vector<CurveReport> measure_curves(const Region& region, const Points2& uv,
                                        const std::vector<Constraint>& constraints,
                                        const std::optional<FeatherlineSide>& side) {
    std::vector<CurveReport> reports;
    for (const CurveRun& run : region.runs) {
        const Lengths lengths = lengths_of(region, uv, run.vertices);
        const Lock* lock = lock_on(run.curve, region.name, constraints);
        reports.push_back({run.curve, lock != nullptr, lengths.in_space, lengths.flat,
                           lengths.flat - lengths.in_space, lengths.worst_edge,
                           verdict_on(lock, lengths)});
        if (side && lock == nullptr && run.curve == curve_name::featherline)
            reports.back().zones = measure_zones(*side, region, uv, run);
    }
    return reports;
}

std::vector<PairReport> measure_pairs(const std::vector<Region>& regions,
                                      const std::vector<Chart>& charts) {
    std::vector<const Region*> all;
    std::vector<std::string> curves;
    for (const Region& region : regions) {
        all.push_back(&region);
        for (const CurveRun& run : region.runs) {
            if (std::find(curves.begin(), curves.end(), run.curve) == curves.end())
                curves.push_back(run.curve);
        }
    }
    std::vector<PairReport> pairs;
    for (const std::string& curve : curves) {
        const auto stretches = seam_stretches(all, curve);
        for (const SeamStretch& both : stretches) {
            const auto lengths = [&](const SeamStretch::Side& side) {
                return lengths_of(regions[side.region], charts[side.region].uv, side.vertices);
            };
            const Lengths a = lengths(both.a), b = lengths(both.b);
            const double difference = a.flat - b.flat;
            pairs.push_back({curve, regions[both.a.region].name, regions[both.b.region].name,
                             a.in_space, difference,
                             std::abs(difference) <= tolerance::pair_difference_mm
                                 ? Verdict::pass
                                 : Verdict::fail});
        }
        if (stretches.empty()) continue;
        if (auto whole = unequal_runs(regions, charts, curve)) pairs.push_back(std::move(*whole));
    }
    return pairs;
}

}  // namespace lastflat
