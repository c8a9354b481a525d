#include "core/prepare.h"

#include <map>
#include <set>

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

void append(std::vector<Warning>& to, const std::vector<Warning>& from) {
    to.insert(to.end(), from.begin(), from.end());
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

Prepared prepare(SurfaceMesh surface, Plan plan, Progress& progress) {
    progress.reach(Stage::cut, 0.25, 0.3);
    CutSurface cut = cut_surface(surface, plan, progress);
    Prepared prepared;
    prepared.constraints = constraints_of(plan, cut.seams);
    check_constraints(prepared.constraints, cut.inserted.curves, cut.regions);
    (void)coupled_regions(cut.regions, prepared.constraints);  // refuses before the maps are made
    check_zones(plan.request.weights.zones, cut.inserted.curves, cut.regions);
    prepared.featherlines = divide_featherlines(surface, cut.regions, plan.request.points);
    prepared.warnings = std::move(surface.warnings);
    if (plan.landmarks) append(prepared.warnings, plan.landmarks->warnings);
    append(prepared.warnings, cut.warnings);
    if (plan.found == Plan::Found::none && !plan.request.cut.regions.empty()) {
        std::vector<std::string> cuts = plan.request.cut.cuts;
        cuts.insert(cuts.end(), cut.seams.begin(), cut.seams.end());
        append(prepared.warnings, left_out_pieces(surface, cut.inserted.curves, cuts, cut.regions));
    }
    prepared.plan = std::move(plan);
    prepared.regions = std::move(cut.regions);
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
