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

}  // namespace

FlattenResult flatten(std::string_view model, const FlattenOptions& options, Progress& progress) {
    FlattenResult result;
    result.method = options.method.name;
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
    for_each_index(regions.size(), options.threads, [&](std::size_t r) {
        minima[r] = options.method.name == MethodName::isometric
                        ? minimise_distortion(regions[r], starts[r].chart,
                                              length_constraints(regions[r], options.locks),
                                              SymmetricDirichlet(), progress)
                        : Minimum{scaled_to_locks(regions[r], starts[r].chart, options.locks)};
    });
    result.timing.constrain_ms = watch.lap();

    progress.reach(Stage::measure, 0.9);
    std::vector<Chart> charts;
    for (std::size_t r = 0; r < regions.size(); ++r) {
        charts.push_back(std::move(minima[r].chart));
        for (auto* warnings : {&starts[r].warnings, &minima[r].warnings}) {
            std::move(warnings->begin(), warnings->end(), std::back_inserter(result.warnings));
        }
    }
    orient_charts(regions, charts);
    result.sheet = arrange_pair(regions, charts, options.layout_gap_mm);
    result.pairs = measure_pairs(regions, charts);
    for (std::size_t r = 0; r < regions.size(); ++r) {
        result.regions.push_back(certified(regions[r], charts[r], options, result.warnings));
        result.regions.back().iterations = minima[r].iterations;
    }
    result.timing.total_ms = total.lap();
    progress.reach(Stage::done, 1.0);
    return result;
}

}  // namespace lastflat
