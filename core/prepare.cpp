#include "core/prepare.h"

#include <map>
#include <set>

#include "core/append.h"
#include "core/constrain/check_constraints.h"
#include "core/constrain/constraint_rows.h"
#include "core/cut/left_out.h"
#include "core/defeature/defeature.h"
#include "core/load/load_model.h"
#include "core/plan/close_opening.h"
#include "core/stopwatch.h"
#include "core/weld/weld.h"

namespace lastflat {
namespace {

/// Every triangle once, under all of its names.
std::vector<NamedFaces> count_groups(const RawMesh& raw) {
    std::vector<std::size_t> of_label(raw.label_sets.size());
    for (const std::uint32_t label : raw.triangle_labels) ++of_label[label];
    std::map<std::vector<std::string>, std::size_t> counts;
    for (std::size_t label = 0; label < of_label.size(); ++label) {
        if (of_label[label] == 0) continue;
        const std::set<std::string> names(raw.label_sets[label].begin(),
                                          raw.label_sets[label].end());
        counts[{names.begin(), names.end()}] += of_label[label];
    }
    std::vector<NamedFaces> groups;
    groups.reserve(counts.size());
    for (const auto& [names, triangles] : counts) groups.push_back({names, triangles});
    return groups;
}

/// The plan's own, and that the sides of every seam become equally long.
std::vector<Constraint> constraints_of(const Plan& plan, const std::vector<std::string>& seams) {
    std::vector<Constraint> constraints = plan.request.constraints;
    for (std::size_t s = 0; s < seams.size(); ++s) {
        constraints.push_back({Seam{seams[s]}});
        if (s < plan.request.cut.seams.size())
            constraints.back().option = {"seams", std::to_string(s)};
    }
    return constraints;
}

}  // namespace

ReadModel read_model(std::string_view model, const FlattenOptions& options, Progress& progress) {
    Stopwatch watch;
    progress.reach(Stage::load, 0.0, 0.1);
    const RawMesh raw = load_model(model, options.limits);
    ReadModel read{raw.positions.size(), raw.triangles.size(), count_groups(raw), {}, watch.lap()};
    progress.reach(Stage::weld, 0.1, 0.15);
    read.surface = weld(raw, options.request.weld, options.request.cut.holes, options.limits);
    progress.reach(Stage::landmarks, 0.15, 0.25);
    close_opening(read.surface, options.request);
    defeature(read.surface, options.request);
    return read;
}

void ask(Prepared& prepared, Plan plan) {
    std::vector<Constraint> constraints = constraints_of(plan, prepared.seams);
    check_constraints(constraints, prepared.curves, prepared.regions);
    (void)coupled_regions(prepared.regions, constraints);  // refuses before the maps are made
    check_zones(plan.request.weights.zones, prepared.curves, prepared.regions);
    prepared.constraints = std::move(constraints);
    prepared.plan = std::move(plan);
}

Prepared prepare(SurfaceMesh surface, Plan plan, Progress& progress) {
    progress.reach(Stage::cut, 0.25, 0.3);
    CutSurface cut = cut_surface(surface, plan, progress);
    Prepared prepared;
    prepared.curves = std::move(cut.inserted.curves);
    prepared.seams = std::move(cut.seams);
    prepared.regions = std::move(cut.regions);
    ask(prepared, std::move(plan));
    const Request& request = prepared.plan.request;
    prepared.featherlines = divide_featherlines(surface, prepared.regions, request.points);
    prepared.warnings = std::move(surface.warnings);
    if (prepared.plan.landmarks) append(prepared.warnings, prepared.plan.landmarks->warnings);
    append(prepared.warnings, std::move(cut.warnings));
    if (prepared.plan.found == Plan::Found::none && !request.cut.regions.empty()) {
        std::vector<std::string> cuts = request.cut.cuts;
        append(cuts, prepared.seams);
        append(prepared.warnings,
               left_out_pieces(surface, prepared.curves, cuts, prepared.regions));
    }
    prepared.sources = SourceIds(surface, std::move(cut.inserted.added));
    prepared.smallest_added_angle = cut.inserted.smallest_angle;
    prepared.repairs = std::move(surface.repairs);
    return prepared;
}

Prepared prepare(std::string_view model, const FlattenOptions& options, Progress& progress) {
    ReadModel read = read_model(model, options, progress);
    Plan plan = make_plan(read.surface, options.request, progress, options.threads);
    Prepared prepared = prepare(std::move(read.surface), std::move(plan), progress);
    prepared.load_ms = read.load_ms;
    return prepared;
}

}  // namespace lastflat
