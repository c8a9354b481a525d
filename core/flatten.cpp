// The whole method on one page; every step is one call.
#include "core/flatten.h"

#include <algorithm>
#include <chrono>

#include "core/constrain/resolve_conflicts.h"
#include "core/constrain/scale_to_locks.h"
#include "core/measure/check_result.h"
#include "core/parallel.h"
#include "core/parameterize/start.h"

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

void check_curve_names(const std::vector<Constraint>& constraints, const Curves& curves) {
    for (const Constraint& constraint : constraints) {
        for (const std::string& name : {constraint.curve, constraint.with_curve}) {
            const bool known =
                name.empty() || std::any_of(curves.begin(), curves.end(),
                                            [&](const Curve& c) { return c.name == name; });
            if (known) continue;
            auto option = constraint.option;
            option.emplace_back(name == constraint.curve ? "curve" : "with_curve");
            throw Error(ErrorCode::curve_invalid,
                        constraint.title() + ": there is no curve '" + name + "'")
                .at_option(option);
        }
    }
}

/// Curves without any edge in a region would be certified by nobody: say so.
void warn_of_absent_curves(const Curves& curves, const std::vector<Region>& regions,
                           std::vector<Warning>& warnings) {
    for (const Curve& curve : curves) {
        const bool present = std::any_of(regions.begin(), regions.end(), [&](const Region& region) {
            return std::any_of(region.runs.begin(), region.runs.end(),
                               [&](const CurveRun& run) { return run.curve == curve.name; });
        });
        if (!present) {
            warnings.push_back({"curve_not_in_regions",
                                "curve '" + curve.name + "' runs through none of the regions",
                                std::nullopt});
        }
    }
}

/// One region of the result, measured and found sound.
FlatRegion certified(const Region& region, const Chart& chart, const FlattenOptions& options,
                     std::vector<Warning>& warnings) {
    FlatRegion flat{region, chart, trace_outline(region, chart),
                    measure_distortion(region, chart.uv),
                    measure_curves(region, chart.uv, options.constraints)};
    check_result(region, chart.uv, options.method.name, flat.metrics, flat.curves, warnings);
    return flat;
}

/// The charts of regions that depend on each other, and how they were found.
struct Refined {
    std::vector<Chart> charts;
    int iterations = 0;
    std::vector<Warning> warnings;
};

/// The starts as they become the answer: at the least of their energy, or scaled as a whole.
Refined refined(const Domain& domain, std::vector<Start> starts, const FlattenOptions& options,
                std::size_t threads, const Progress& progress) {
    Refined result;
    for (Start& start : starts) {
        result.charts.push_back(std::move(start.chart));
        std::move(start.warnings.begin(), start.warnings.end(),
                  std::back_inserter(result.warnings));
    }
    const auto minimise = [&](const IsotropicEnergy& energy,
                              const std::vector<Constraint>& constraints) {
        ConstrainedChart best = least_distortion(domain, result.charts, constraints, energy,
                                                 options.on_conflict, threads, progress);
        result.charts = std::move(best.minimum.charts);
        result.iterations = best.minimum.iterations;
        std::move(best.warnings.begin(), best.warnings.end(), std::back_inserter(result.warnings));
    };
    const auto scale_to_locks = [&] {
        for (std::size_t r = 0; r < domain.regions.size(); ++r) {
            result.charts[r] = scaled_to_locks(*domain.regions[r], std::move(result.charts[r]),
                                               options.constraints);
        }
    };
    switch (options.method.name) {
        case MethodName::isometric: minimise(SymmetricDirichlet(), options.constraints); break;
        case MethodName::green_lagrange: minimise(GreenLagrange(), {}); break;
        case MethodName::mips:
            minimise(Mips(), {});
            scale_to_locks();
            break;
        default: scale_to_locks();
    }
    return result;
}

Refined refine(const std::vector<std::size_t>& group, const std::vector<Region>& regions,
               std::vector<Start>& starts, const FlattenOptions& options,
               const Progress& progress) {
    std::vector<const Region*> parts;
    std::vector<Start> own;
    for (const std::size_t r : group) {
        parts.push_back(&regions[r]);
        own.push_back(std::move(starts[r]));
    }
    return refined(Domain(parts), std::move(own), options, options.threads, progress);
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

/// Regions with the same first place depend on each other; they are solved together.
struct Group {
    std::vector<std::size_t> regions;
    Refined refined;
};

/// The charts laid on the sheet, measured and found sound.
void finish(const std::vector<Region>& regions, std::vector<Group> groups, std::vector<Fan> fans,
            const FlattenOptions& options, FlattenResult& result) {
    std::vector<Chart> charts(regions.size());
    std::vector<int> iterations(regions.size());
    std::vector<Index> centres;
    for (Group& group : groups) {
        for (std::size_t i = 0; i < group.regions.size(); ++i) {
            charts[group.regions[i]] = std::move(group.refined.charts[i]);
            iterations[group.regions[i]] = group.refined.iterations;
        }
        std::move(group.refined.warnings.begin(), group.refined.warnings.end(),
                  std::back_inserter(result.warnings));
    }
    for (Fan& fan : fans) {
        centres.push_back(fan.fan ? fan.fan->centre : -1);
        std::move(fan.warnings.begin(), fan.warnings.end(), std::back_inserter(result.warnings));
    }
    orient_charts(regions, centres, charts);
    result.sheet = arrange_pair(regions, charts, options.layout_gap_mm);
    result.pairs = measure_pairs(regions, charts);
    for (std::size_t r = 0; r < regions.size(); ++r) {
        FlatRegion flat = certified(regions[r], charts[r], options, result.warnings);
        flat.iterations = iterations[r];
        if (fans[r].fan) flat.fan = on_base_line(regions[r], charts[r], std::move(*fans[r].fan));
        result.regions.push_back(std::move(flat));
    }
}

}  // namespace

FlattenResult flatten(std::string_view model, const FlattenOptions& options, Progress& progress) {
    FlattenResult result;
    result.method = options.method.name;
    result.draw_fan = options.draw_fan;
    Stopwatch total, watch;

    progress.reach(Stage::load, 0.0);
    const RawMesh raw = load_model(model, options.limits);
    result.timing.load_ms = watch.lap();

    progress.reach(Stage::weld, 0.1);
    SurfaceMesh surface = weld(raw, options.weld);
    result.warnings = std::move(surface.warnings);

    progress.reach(Stage::cut, 0.2);
    const Curves curves = locate_curves(surface, options.curves);
    check_curve_names(options.constraints, curves);
    const auto regions = cut_into_regions(surface, curves, options.cut);
    warn_of_absent_curves(curves, regions, result.warnings);
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
    for_each_index(groups.size() + regions.size(), options.threads, [&](std::size_t task) {
        if (task < groups.size()) {
            groups[task].refined = refine(groups[task].regions, regions, starts, options, progress);
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
