// The whole method on one page; every step is one call.
#include "core/flatten.h"

#include <algorithm>
#include <chrono>

#include "core/constrain/constrained_newton.h"
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

void check_locks(const std::vector<Lock>& locks, const Curves& curves) {
    for (std::size_t i = 0; i < locks.size(); ++i) {
        const bool known = std::any_of(curves.begin(), curves.end(),
                                       [&](const Curve& c) { return c.name == locks[i].curve; });
        if (!known) {
            throw Error(ErrorCode::curve_invalid, "lock on '" + locks[i].curve + "' names no curve")
                .at_option({"locks", std::to_string(i), "curve"});
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
                    measure_curves(region, chart.uv, options.locks)};
    check_result(region, chart.uv, options.method.name, flat.metrics, flat.curves, warnings);
    return flat;
}

/// The start as it becomes the answer: at the least of its energy, or scaled as a whole.
Minimum refined(const Region& region, Start start, const FlattenOptions& options,
                const Progress& progress) {
    const auto minimised = [&](const IsotropicEnergy& energy, const std::vector<Lock>& locks) {
        return minimise_distortion(region, start.chart, length_constraints(region, locks), energy,
                                   progress);
    };
    Minimum result;
    switch (options.method.name) {
        case MethodName::isometric: result = minimised(SymmetricDirichlet(), options.locks); break;
        case MethodName::green_lagrange: result = minimised(GreenLagrange(), {}); break;
        case MethodName::mips:
            result = minimised(Mips(), {});
            result.chart = scaled_to_locks(region, std::move(result.chart), options.locks);
            break;
        default: result.chart = scaled_to_locks(region, std::move(start.chart), options.locks);
    }
    result.warnings.insert(result.warnings.begin(), start.warnings.begin(), start.warnings.end());
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

/// The charts laid on the sheet, measured and found sound.
void finish(const std::vector<Region>& regions, std::vector<Minimum> minima, std::vector<Fan> fans,
            const FlattenOptions& options, FlattenResult& result) {
    std::vector<Chart> charts;
    std::vector<Index> centres;
    for (std::size_t r = 0; r < regions.size(); ++r) {
        charts.push_back(std::move(minima[r].chart));
        centres.push_back(fans[r].fan ? fans[r].fan->centre : -1);
        for (auto* warnings : {&minima[r].warnings, &fans[r].warnings}) {
            std::move(warnings->begin(), warnings->end(), std::back_inserter(result.warnings));
        }
    }
    orient_charts(regions, centres, charts);
    result.sheet = arrange_pair(regions, charts, options.layout_gap_mm);
    result.pairs = measure_pairs(regions, charts);
    for (std::size_t r = 0; r < regions.size(); ++r) {
        FlatRegion flat = certified(regions[r], charts[r], options, result.warnings);
        flat.iterations = minima[r].iterations;
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
    check_locks(options.locks, curves);
    const auto regions = cut_into_regions(surface, curves, options.cut);
    warn_of_absent_curves(curves, regions, result.warnings);
    result.timing.cut_ms = watch.lap();

    progress.reach(Stage::parameterize, 0.3);
    std::vector<Start> starts(regions.size());
    for_each_index(regions.size(), options.threads, [&](std::size_t r) {
        progress.check();
        starts[r] =
            start_chart(regions[r], locked_border_edges(regions[r], options.locks), options.method);
    });
    result.timing.parameterize_ms = watch.lap();

    progress.reach(Stage::constrain, 0.5);
    std::vector<Minimum> minima(regions.size());
    std::vector<Fan> fans(regions.size());
    for_each_index(2 * regions.size(), options.threads, [&](std::size_t task) {
        const std::size_t r = task % regions.size();
        if (task < regions.size()) {
            minima[r] = refined(regions[r], std::move(starts[r]), options, progress);
        } else {
            fans[r] = fan_of(regions[r], options, progress);
        }
    });
    result.timing.constrain_ms = watch.lap();

    progress.reach(Stage::measure, 0.9);
    finish(regions, std::move(minima), std::move(fans), options, result);
    result.timing.total_ms = total.lap();
    progress.reach(Stage::done, 1.0);
    return result;
}

}  // namespace lastflat
