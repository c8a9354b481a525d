#include "core/solve.h"

#include <algorithm>
#include <atomic>

#include "core/append.h"
#include "core/constrain/constraint_rows.h"
#include "core/parallel.h"

namespace lastflat {
namespace {

Fan fan_of(const Region& region, const Request& request, const FlattenOptions& options,
           const Progress& progress) {
    if (!request.draw_fan && !tells_fan(request)) return {};
    if (region.triangles.size() > options.fan_triangles) {
        return {std::nullopt,
                {{"no_fan",
                  "region '" + region.name + "' has more than " +
                      std::to_string(options.fan_triangles) +
                      " triangles: its geodesic fan is left out",
                  std::nullopt}}};
    }
    try {
        return {geodesic_fan(region, request.draw_fan, progress), {}};
    } catch (const Error& error) {
        if (error.code() != ErrorCode::solver_failed) throw;
        return {std::nullopt,
                {{"no_fan", "region '" + region.name + "' has no geodesic fan: " + error.what(),
                  error.position()}}};
    }
}

std::vector<const Region*> parts_of(const Prepared& prepared,
                                    const std::vector<std::size_t>& group) {
    std::vector<const Region*> parts;
    parts.reserve(group.size());
    for (const std::size_t r : group) parts.push_back(&prepared.regions[r]);
    return parts;
}

ConstrainedChart refined(const Prepared& prepared, const std::vector<std::size_t>& group,
                         std::vector<Start>& starts, std::size_t threads, const Progress& progress,
                         Warmth* left) {
    std::vector<Chart> charts;
    std::vector<Warning> warnings;
    for (const std::size_t r : group) {
        charts.push_back(std::move(starts[r].chart));
        append(warnings, std::move(starts[r].warnings));
    }
    ConstrainedChart result =
        refine(Domain(parts_of(prepared, group)), std::move(charts), prepared.plan.request,
               prepared.constraints, threads, progress, left);
    append(warnings, std::move(result.warnings));
    result.warnings = std::move(warnings);
    return result;
}

/// Groups with their fans; calls solve_group(i, threads) for each.
template <class SolveGroup>
Solution solved(const Prepared& prepared, std::vector<std::vector<std::size_t>> groups,
                const FlattenOptions& options, const Progress& progress,
                const SolveGroup& solve_group) {
    const std::vector<Region>& regions = prepared.regions;
    Solution solution{{}, std::vector<Fan>(regions.size())};
    for (auto& group : groups) solution.groups.push_back({std::move(group)});
    const std::size_t count = solution.groups.size();
    const std::size_t inner_threads = std::max<std::size_t>(1, options.threads / count);
    for_each_index(count + regions.size(), options.threads, [&](std::size_t task) {
        if (task < count) {
            solve_group(solution.groups[task], task, inner_threads);
        } else {
            const std::size_t r = task - count;
            solution.fans[r] = fan_of(regions[r], prepared.plan.request, options, progress);
        }
    });
    return solution;
}

}  // namespace

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

Solution solve(const Prepared& prepared, std::vector<Start> starts, const FlattenOptions& options,
               const Progress& progress, WarmGroups* left) {
    auto groups = coupled_regions(prepared.regions, prepared.constraints);
    if (left != nullptr) left->clear();
    WarmGroups warm(left != nullptr ? groups.size() : 0);
    Solution solution = solved(prepared, std::move(groups), options, progress,
                               [&](SolvedGroup& group, std::size_t g, std::size_t threads) {
                                   group.refined =
                                       refined(prepared, group.regions, starts, threads, progress,
                                               left != nullptr ? &warm[g].warmth : nullptr);
                               });
    for (std::size_t g = 0; g < warm.size(); ++g) warm[g].regions = solution.groups[g].regions;
    if (left != nullptr) *left = std::move(warm);
    return solution;
}

std::optional<Solution> solve_again(const Prepared& prepared, const FlattenOptions& options,
                                    const Progress& progress, WarmGroups& warm) {
    auto groups = coupled_regions(prepared.regions, prepared.constraints);
    const bool same =
        std::equal(groups.begin(), groups.end(), warm.begin(), warm.end(),
                   [](const auto& group, const WarmGroup& was) { return group == was.regions; });
    if (!same) return std::nullopt;
    std::atomic<bool> all = true;
    Solution solution = solved(prepared, std::move(groups), options, progress,
                               [&](SolvedGroup& group, std::size_t g, std::size_t threads) {
                                   auto refined =
                                       refine_again(Domain(parts_of(prepared, group.regions)),
                                                    prepared.plan.request, prepared.constraints,
                                                    threads, progress, warm[g].warmth);
                                   if (refined)
                                       group.refined = std::move(*refined);
                                   else
                                       all = false;
                               });
    if (!all) return std::nullopt;
    return solution;
}

void refresh(const Prepared& prepared, const FlattenOptions& options, const Progress& progress,
             WarmGroups& warm) {
    const std::size_t inner_threads =
        std::max<std::size_t>(1, options.threads / std::max<std::size_t>(1, warm.size()));
    for_each_index(warm.size(), options.threads, [&](std::size_t g) {
        refresh(Domain(parts_of(prepared, warm[g].regions)), prepared.plan.request,
                prepared.constraints, inner_threads, progress, warm[g].warmth);
    });
}

}  // namespace lastflat
