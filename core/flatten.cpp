// The whole method on one page; every step is one call.
#include "core/flatten.h"

#include <algorithm>
#include <iterator>

#include "core/constrain/constraint_rows.h"
#include "core/constrain/refine.h"
#include "core/measure/check_result.h"
#include "core/parallel.h"
#include "core/parameterize/start.h"
#include "core/prepare.h"
#include "core/stopwatch.h"

namespace lastflat {
namespace {

template <class T>
void append(std::vector<T>& to, std::vector<T> from) {
    std::move(from.begin(), from.end(), std::back_inserter(to));
}

std::vector<Start> start_charts(const Prepared& prepared, std::size_t threads,
                                const Progress& progress) {
    const std::vector<Region>& regions = prepared.regions;
    std::vector<Start> starts(regions.size());
    for_each_index(regions.size(), threads, [&](std::size_t r) {
        progress.check();
        starts[r] = start_chart(regions[r], locked_border_edges(regions[r], prepared.constraints),
                                prepared.plan.request.method);
    });
    return starts;
}

struct Fan {
    std::optional<GeodesicFan> fan;
    std::vector<Warning> warnings;
};

/// For whoever asks for it; nothing depends on it.
Fan fan_of(const Region& region, const FlattenOptions& options, const Progress& progress) {
    if (!options.request.draw_fan && !tells_fan(options.request)) return {};
    if (region.triangles.size() > options.fan_triangles) {
        return {std::nullopt,
                {{"no_fan",
                  "region '" + region.name + "' has more than " +
                      std::to_string(options.fan_triangles) +
                      " triangles: its geodesic fan is left out",
                  std::nullopt}}};
    }
    try {
        return {geodesic_fan(region, options.request.draw_fan, progress), {}};
    } catch (const Error& error) {
        if (error.code() != ErrorCode::solver_failed) throw;
        return {std::nullopt,
                {{"no_fan", "region '" + region.name + "' has no geodesic fan: " + error.what(),
                  error.position()}}};
    }
}

/// Regions that depend on each other, by their indices.
struct Group {
    std::vector<std::size_t> regions;
    ConstrainedChart refined{};
};

struct Solution {
    std::vector<Group> groups;
    std::vector<Fan> fans;  ///< per region
};

ConstrainedChart refined(const Prepared& prepared, const std::vector<std::size_t>& group,
                         std::vector<Start>& starts, std::size_t threads,
                         const Progress& progress) {
    std::vector<const Region*> parts;
    std::vector<Chart> charts;
    std::vector<Warning> warnings;
    for (const std::size_t r : group) {
        parts.push_back(&prepared.regions[r]);
        charts.push_back(std::move(starts[r].chart));
        append(warnings, std::move(starts[r].warnings));
    }
    ConstrainedChart result = refine(Domain(parts), std::move(charts), prepared.plan.request,
                                     prepared.constraints, threads, progress);
    append(warnings, std::move(result.warnings));
    result.warnings = std::move(warnings);
    return result;
}

Solution solve(const Prepared& prepared, std::vector<Start> starts, const FlattenOptions& options,
               const Progress& progress) {
    const std::vector<Region>& regions = prepared.regions;
    Solution solution{{}, std::vector<Fan>(regions.size())};
    std::vector<Group>& groups = solution.groups;
    for (auto& group : coupled_regions(regions, prepared.constraints))
        groups.push_back({std::move(group)});
    const std::size_t inner_threads = std::max<std::size_t>(1, options.threads / groups.size());
    for_each_index(groups.size() + regions.size(), options.threads, [&](std::size_t task) {
        if (task < groups.size()) {
            groups[task].refined =
                refined(prepared, groups[task].regions, starts, inner_threads, progress);
        } else {
            const std::size_t r = task - groups.size();
            solution.fans[r] = fan_of(regions[r], options, progress);
        }
    });
    return solution;
}

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

/// The next region of the result, measured and found sound.
FlatRegion certified(Region region, Chart chart, const Minimum& minimum,
                     std::optional<GeodesicFan> fan, FlattenResult& result) {
    const Request& request = result.plan.request;
    FlatRegion flat{
        {},
        {},
        trace_outline(region, chart),
        measure_distortion(region, chart.uv),
        measure_curves(region, chart.uv, result.asked, side_of(result, result.regions.size())),
        measure_stretch(region, chart.uv, request.material, side_of(result, result.regions.size())),
        minimum.iterations};
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

/// The charts laid on the sheet, measured and found sound.
FlattenResult measured(Prepared prepared, Solution solution, double layout_gap_mm) {
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
    for (Group& group : solution.groups) {
        for (std::size_t i = 0; i < group.regions.size(); ++i) {
            charts[group.regions[i]] = std::move(group.refined.minimum.charts[i]);
            minima[group.regions[i]] = &group.refined.minimum;
        }
        append(relaxed, std::move(group.refined.relaxed));
        append(result.warnings, std::move(group.refined.warnings));
    }
    for (Fan& fan : solution.fans) append(result.warnings, std::move(fan.warnings));
    orient_charts(regions, without(result.asked, relaxed), charts);
    result.sheet = arrange_pair(regions, charts, layout_gap_mm);
    result.pairs = measure_pairs(regions, charts);
    report_constraints(regions, charts, relaxed, result);
    for (std::size_t r = 0; r < regions.size(); ++r) {
        result.regions.push_back(certified(std::move(regions[r]), std::move(charts[r]), *minima[r],
                                           std::move(solution.fans[r].fan), result));
    }
    return result;
}

}  // namespace

FlattenResult flatten(std::string_view model, const FlattenOptions& options, Progress& progress) {
    Stopwatch total, lap;
    Prepared prepared = prepare(model, options, progress);
    Timing timing{prepared.load_ms, lap.lap() - prepared.load_ms};

    progress.reach(Stage::parameterize, 0.3, 0.5);
    std::vector<Start> starts = start_charts(prepared, options.threads, progress);
    timing.parameterize_ms = lap.lap();

    progress.reach(Stage::constrain, 0.5, 0.9);
    Solution solution = solve(prepared, std::move(starts), options, progress);
    timing.constrain_ms = lap.lap();

    progress.reach(Stage::measure, 0.9, 1.0);
    FlattenResult result =
        measured(std::move(prepared), std::move(solution), options.layout_gap_mm);
    timing.total_ms = total.lap();
    result.timing = timing;
    progress.reach(Stage::done, 1.0, 1.0);
    return result;
}

}  // namespace lastflat
