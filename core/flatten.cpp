// The whole method on one page; every step is one call.
#include "core/flatten.h"

#include <algorithm>
#include <chrono>

#include "core/constrain/resolve_conflicts.h"
#include "core/constrain/scale_to_locks.h"
#include "core/measure/check_result.h"
#include "core/parallel.h"
#include "core/parameterize/start.h"
#include "core/prepare.h"

namespace lastflat {
namespace {

class Stopwatch {
public:
    /// Milliseconds since the last lap.
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        const double ms = std::chrono::duration<double, std::milli>(now - last_).count();
        last_ = now;
        return ms;
    }

private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// One region of the result, measured and found sound.
FlatRegion certified(const Region& region, const Chart& chart, const FlattenOptions& options,
                     std::vector<Warning>& warnings) {
    FlatRegion flat{region,
                    chart,
                    trace_outline(region, chart),
                    measure_distortion(region, chart.uv),
                    measure_curves(region, chart.uv, options.constraints),
                    {}};
    check_result(region, chart.uv, options.method.name, flat.metrics, warnings);
    flat.stretch = measure_stretch(region, chart.uv, options.material);
    return flat;
}

template <class T>
void append(std::vector<T>& to, std::vector<T> from) {
    std::move(from.begin(), from.end(), std::back_inserter(to));
}

ConstrainedChart isometric(const Domain& domain, const std::vector<Chart>& starts,
                           const FlattenOptions& options, std::size_t threads,
                           const Progress& progress) {
    std::vector<std::vector<double>> weights;
    for (const Region* region : domain.regions)
        weights.push_back(triangle_weights(*region, options.weights.zones));
    const SymmetricDirichlet even;
    const WeightedDirichlet uneven(options.weights.stretch, options.weights.compression);
    const IsotropicEnergy& energy =
        options.weights.even() ? static_cast<const IsotropicEnergy&>(even) : uneven;
    return least_distortion(
        domain, starts,
        {options.constraints, energy, std::move(weights), options.on_conflict, true}, threads,
        progress);
}

/// The starts as they become the answer: at the least of their energy, or scaled as a whole.
ConstrainedChart refined(const Domain& domain, std::vector<Chart> charts,
                         const FlattenOptions& options, std::size_t threads,
                         const Progress& progress) {
    const std::vector<Constraint> none;
    const bool mips = options.method.name == MethodName::mips;
    switch (options.method.name) {
        case MethodName::isometric: return isometric(domain, charts, options, threads, progress);
        case MethodName::green_lagrange:
            return least_distortion(domain, charts, {none, GreenLagrange()}, threads, progress);
        default: break;
    }
    ConstrainedChart result;
    if (mips) {
        result = least_distortion(domain, charts, {none, Mips()}, threads, progress);
        charts = std::move(result.minimum.charts);
    }
    result.minimum.charts.clear();
    for (std::size_t r = 0; r < domain.regions.size(); ++r) {
        result.minimum.charts.push_back(
            scaled_to_locks(*domain.regions[r], std::move(charts[r]), options.constraints));
    }
    return result;
}

ConstrainedChart refine(const std::vector<std::size_t>& group, const std::vector<Region>& regions,
                        std::vector<Start>& starts, const FlattenOptions& options,
                        std::size_t threads, const Progress& progress) {
    std::vector<const Region*> parts;
    std::vector<Chart> charts;
    std::vector<Warning> warnings;
    for (const std::size_t r : group) {
        parts.push_back(&regions[r]);
        charts.push_back(std::move(starts[r].chart));
        append(warnings, std::move(starts[r].warnings));
    }
    ConstrainedChart result = refined(Domain(parts), std::move(charts), options, threads, progress);
    append(warnings, std::move(result.warnings));
    result.warnings = std::move(warnings);
    return result;
}

struct Fan {
    std::optional<GeodesicFan> fan;
    std::vector<Warning> warnings;
};

/// The fan says where the chart lies and that it is sane; without it the chart is as good.
Fan fan_of(const Region& region, const FlattenOptions& options, const Progress& progress) {
    if (!options.draw_fan && region.triangles.size() > options.fan_triangles) return {};
    if (region.triangles.size() > options.drawn_fan_triangles) {
        return {std::nullopt,
                {{"no_fan",
                  "region '" + region.name + "' has more than " +
                      std::to_string(options.drawn_fan_triangles) +
                      " triangles: its geodesic fan is not drawn",
                  std::nullopt}}};
    }
    try {
        return {geodesic_fan(region, options.draw_fan, progress), {}};
    } catch (const Error& error) {
        if (error.code() != ErrorCode::solver_failed) throw;
        return {std::nullopt,
                {{"no_fan", "region '" + region.name + "' has no geodesic fan: " + error.what(),
                  error.position()}}};
    }
}

/// Regions that depend on each other, by their places in the list.
struct Group {
    std::vector<std::size_t> regions;
    ConstrainedChart refined;
};

void report_constraints(const std::vector<Region>& regions, const std::vector<Chart>& charts,
                        const std::vector<std::size_t>& relaxed, const FlattenOptions& options,
                        FlattenResult& result) {
    result.constraints = measure_constraints(regions, charts, options.constraints);
    for (ConstraintReport& report : result.constraints) {
        report.relaxed =
            std::find(relaxed.begin(), relaxed.end(), report.constraint) != relaxed.end();
    }
    if (options.method.name == MethodName::isometric)
        check_constraints_kept(result.constraints, options.constraints, result.warnings);
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

/// The charts laid on the sheet, measured and found sound.
void finish(const std::vector<Region>& regions, std::vector<Group> groups, std::vector<Fan> fans,
            const FlattenOptions& options, FlattenResult& result) {
    std::vector<Chart> charts(regions.size());
    std::vector<const Minimum*> minima(regions.size());
    std::vector<std::size_t> relaxed;
    std::vector<Index> centres;
    for (Group& group : groups) {
        for (std::size_t i = 0; i < group.regions.size(); ++i) {
            charts[group.regions[i]] = std::move(group.refined.minimum.charts[i]);
            minima[group.regions[i]] = &group.refined.minimum;
        }
        append(relaxed, std::move(group.refined.relaxed));
        append(result.warnings, std::move(group.refined.warnings));
    }
    for (Fan& fan : fans) {
        centres.push_back(fan.fan ? fan.fan->centre : -1);
        append(result.warnings, std::move(fan.warnings));
    }
    orient_charts(regions, centres, without(options.constraints, relaxed), charts);
    result.sheet = arrange_pair(regions, charts, options.layout_gap_mm);
    result.pairs = measure_pairs(regions, charts);
    report_constraints(regions, charts, relaxed, options, result);
    for (std::size_t r = 0; r < regions.size(); ++r) {
        FlatRegion flat = certified(regions[r], charts[r], options, result.warnings);
        flat.iterations = minima[r]->iterations;
        if (is_energy(options.method.name)) {
            flat.energy = minima[r]->energy;
            flat.projected_gradient = minima[r]->projected_gradient;
        }
        if (fans[r].fan) flat.fan = on_base_line(regions[r], charts[r], std::move(*fans[r].fan));
        result.regions.push_back(std::move(flat));
    }
}

/// The surface, mended, and what is to be done with it.
SurfaceMesh read_surface(std::string_view model, FlattenOptions& options, FlattenResult& result,
                         Stopwatch& watch, Progress& progress) {
    progress.reach(Stage::load, 0.0);
    const RawMesh raw = load_model(model, options.limits);
    result.timing.load_ms = watch.lap();
    progress.reach(Stage::weld, 0.1);
    SurfaceMesh surface = weld(raw, options.weld);
    result.warnings = std::move(surface.warnings);
    result.repairs = std::move(surface.repairs);
    result.found = fill_in_landmarks(surface, options);
    if (result.found) append(result.warnings, result.found->warnings);
    name_welded_vertices(surface, options);
    return surface;
}

}  // namespace

FlattenResult flatten(std::string_view model, const FlattenOptions& asked, Progress& progress) {
    FlattenResult result;
    FlattenOptions options = asked;
    result.method = options.method.name;
    result.draw_fan = options.draw_fan;
    Stopwatch total, watch;
    SurfaceMesh surface = read_surface(model, options, result, watch, progress);

    progress.reach(Stage::cut, 0.2);
    const Found by_itself = !result.found          ? Found::none
                            : asked.curves.empty() ? Found::all
                                                   : Found::some;
    CutSurface cut = cut_surface(surface, options, by_itself, progress);
    append(result.warnings, std::move(cut.warnings));
    result.asked = options.constraints;
    result.file_vertices = surface.welded_to.size();
    result.added_vertices = std::move(cut.inserted.added);
    result.smallest_added_angle = cut.inserted.smallest_angle;
    const std::vector<Region>& regions = cut.regions;
    result.timing.cut_ms = watch.lap();

    progress.reach(Stage::parameterize, 0.3);
    std::vector<Start> starts(regions.size());
    for_each_index(regions.size(), options.threads, [&](std::size_t r) {
        progress.check();
        starts[r] = start_chart(regions[r], locked_border_edges(regions[r], options.constraints),
                                options.method);
    });
    result.timing.parameterize_ms = watch.lap();

    progress.reach(Stage::constrain, 0.5);
    std::vector<Group> groups;
    for (auto& group : coupled_regions(regions, options.constraints))
        groups.push_back({std::move(group), {}});
    std::vector<Fan> fans(regions.size());
    const std::size_t inner_threads = std::max<std::size_t>(1, options.threads / groups.size());
    for_each_index(groups.size() + regions.size(), options.threads, [&](std::size_t task) {
        if (task < groups.size()) {
            groups[task].refined =
                refine(groups[task].regions, regions, starts, options, inner_threads, progress);
        } else {
            fans[task - groups.size()] = fan_of(regions[task - groups.size()], options, progress);
        }
    });
    result.timing.constrain_ms = watch.lap();

    progress.reach(Stage::measure, 0.9);
    finish(regions, std::move(groups), std::move(fans), options, result);
    result.timing.total_ms = total.lap();
    progress.reach(Stage::done, 1.0);
    return result;
}

}  // namespace lastflat
