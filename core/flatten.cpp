// The whole method on one page; every step is one call.
#include "core/flatten.h"

#include "core/assemble.h"
#include "core/stopwatch.h"

namespace lastflat {

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
    FlattenResult result = assembled(std::move(prepared), std::move(solution), options);
    timing.total_ms = total.lap();
    result.timing = timing;
    progress.reach(Stage::done, 1.0, 1.0);
    return result;
}

}  // namespace lastflat
