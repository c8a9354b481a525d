#include "core/assemble.h"

#include <algorithm>

#include "core/append.h"
#include "core/measure/check_result.h"
#include "core/parallel.h"

namespace lastflat {
namespace {

/// A pin that gave way does not say where a chart lies.
std::vector<Constraint> without(const std::vector<Constraint>& constraints,
                                const std::vector<std::size_t>& relaxed) {
    std::vector<Constraint> held;
    for (std::size_t c = 0; c < constraints.size(); ++c) {
        if (std::find(relaxed.begin(), relaxed.end(), c) == relaxed.end())
            held.push_back(constraints[c]);
    }
    return held;
}

void report_constraints(const std::vector<Region>& regions, const std::vector<Chart>& charts,
                        const std::vector<std::size_t>& relaxed, FlattenResult& result) {
    result.constraints = measure_constraints(regions, charts, result.asked);
    for (ConstraintReport& report : result.constraints) {
        report.relaxed =
            std::find(relaxed.begin(), relaxed.end(), report.constraint) != relaxed.end();
    }
    if (result.plan.request.method.name == MethodName::isometric)
        check_constraints_kept(result.constraints, result.asked, result.warnings);
}

std::optional<FeatherlineSide> side_of(const FlattenResult& result, std::size_t region) {
    for (const FeatherlineSide& side : result.featherlines) {
        if (side.region == region) return side;
    }
    return std::nullopt;
}

/// Every region on its own, no measure depending on another.
std::vector<FlatRegion> measured(const std::vector<Region>& regions,
                                 const std::vector<Chart>& charts, const FlattenResult& result,
                                 std::size_t threads) {
    std::vector<FlatRegion> flat(regions.size());
    constexpr std::size_t measures = 3;
    for_each_index(measures * regions.size(), threads, [&](std::size_t task) {
        const std::size_t r = task / measures;
        const Region& region = regions[r];
        const Points2& uv = charts[r].uv;
        const auto side = side_of(result, r);
        switch (task % measures) {
            case 0:
                flat[r].stretch = measure_stretch(region, uv, result.plan.request.material, side);
                break;
            case 1: flat[r].metrics = measure_distortion(region, uv); break;
            default:
                flat[r].curves = measure_curves(region, uv, result.asked, side);
                flat[r].outline = trace_outline(region, charts[r]);
        }
    });
    return flat;
}

/// The next region of the result, found sound.
FlatRegion certified(FlatRegion flat, Region region, Chart chart, const Minimum& minimum,
                     std::optional<GeodesicFan> fan, FlattenResult& result) {
    const Request& request = result.plan.request;
    flat.iterations = minimum.iterations;
    flat.metrics.area_verdict = area_verdict(region, flat.metrics, result.asked);
    check_result(region, chart.uv, request.method.name, flat.metrics, result.warnings);
    if (request.method.name == MethodName::isometric)
        check_distortion(region, flat.metrics, flat.stretch, result.plan.landmarks.has_value(),
                         result.warnings);
    if (is_energy(request.method.name)) {
        flat.energy = minimum.energy;
        flat.projected_gradient = minimum.projected_gradient;
    }
    if (fan) flat.fan = on_base_line(region, chart, std::move(*fan));
    flat.region = std::move(region);
    flat.chart = std::move(chart);
    return flat;
}

}  // namespace

FlattenResult assembled(Prepared prepared, Solution solution, const FlattenOptions& options) {
    FlattenResult result;
    result.plan = std::move(prepared.plan);
    result.featherlines = std::move(prepared.featherlines);
    result.asked = std::move(prepared.constraints);
    result.warnings = std::move(prepared.warnings);
    result.sources = std::move(prepared.sources);
    result.smallest_added_angle = prepared.smallest_added_angle;
    result.repairs = std::move(prepared.repairs);
    std::vector<Region>& regions = prepared.regions;
    std::vector<Chart> charts(regions.size());
    std::vector<const Minimum*> minima(regions.size());
    std::vector<std::size_t> relaxed;
    for (SolvedGroup& group : solution.groups) {
        for (std::size_t i = 0; i < group.regions.size(); ++i) {
            charts[group.regions[i]] = std::move(group.refined.minimum.charts[i]);
            minima[group.regions[i]] = &group.refined.minimum;
        }
        append(relaxed, std::move(group.refined.relaxed));
        append(result.warnings, std::move(group.refined.warnings));
    }
    for (Fan& fan : solution.fans) append(result.warnings, std::move(fan.warnings));
    orient_charts(regions, without(result.asked, relaxed), charts);
    result.sheet = arrange_pair(regions, charts, options.layout_gap_mm);
    result.pairs = measure_pairs(regions, charts);
    report_constraints(regions, charts, relaxed, result);
    std::vector<FlatRegion> flat = measured(regions, charts, result, options.threads);
    for (std::size_t r = 0; r < regions.size(); ++r) {
        result.regions.push_back(certified(std::move(flat[r]), std::move(regions[r]),
                                           std::move(charts[r]), *minima[r],
                                           std::move(solution.fans[r].fan), result));
    }
    return result;
}

}  // namespace lastflat
