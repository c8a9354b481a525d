#include "core/session/session.h"

#include <algorithm>
#include <map>

#include "core/assemble.h"
#include "core/flatten.h"
#include "core/plan/plan.h"
#include "core/session/carry_chart.h"
#include "core/stopwatch.h"

namespace lastflat {

/// What a change of the request leaves alone, as a rule.
struct Session::Model {
    explicit Model(SurfaceMesh mesh) : surface(std::move(mesh)), search(surface) {}

    const SurfaceMesh surface;
    const SurfaceSearch search;
    std::optional<Landmarks> landmarks{};  ///< once they were asked for
};

/// All that a request led to.
struct Session::State {
    ShownApart asked;
    std::shared_ptr<Model> model;
    std::vector<SurfaceLine> lines{};  ///< of the curves that are in the surface
    Prepared prepared{};
    WarmGroups warm{};
    FlattenResult result{};
    std::shared_ptr<PatternMap> map{};
    std::vector<ShownCurve> curves{};
};

namespace {

std::vector<FlatPiece> pieces_of(const FlattenResult& result) {
    std::vector<FlatPiece> pieces;
    for (const FlatRegion& flat : result.regions)
        pieces.push_back(
            {flat.region.name, flat.region.positions, flat.chart.uv, flat.region.triangles});
    return pieces;
}

std::vector<Points2> charts_of(const FlattenResult& result) {
    std::vector<Points2> charts;
    for (const FlatRegion& flat : result.regions) charts.push_back(flat.chart.uv);
    return charts;
}

/// Per region the chart of the old region of its name, carried over; empty if any has none.
std::vector<Start> carried_starts(const std::vector<Region>& regions, const FlattenResult& before) {
    std::vector<Start> starts;
    for (const Region& region : regions) {
        const auto old =
            std::find_if(before.regions.begin(), before.regions.end(),
                         [&](const FlatRegion& flat) { return flat.region.name == region.name; });
        if (old == before.regions.end()) return {};
        auto chart = carried_chart(old->region, old->chart, region);
        if (!chart) return {};
        starts.push_back({std::move(*chart), {}});
    }
    return starts;
}

/// As many as a good factor needs.
bool took_few_steps(const Solution& solution) {
    constexpr int few = 3;
    return std::all_of(
        solution.groups.begin(), solution.groups.end(),
        [](const SolvedGroup& group) { return group.refined.minimum.iterations <= few; });
}

/// How far the vertices of the file that both pieces have once lie apart at most, mm.
double difference(const FlatRegion& a, const SourceIds& a_ids, const FlatRegion& b,
                  const SourceIds& b_ids) {
    const auto places = [](const FlatRegion& flat, const SourceIds& ids) {
        std::map<Index, std::pair<int, Vec2>> found;
        for (std::size_t v = 0; v < flat.chart.uv.size(); ++v) {
            if (const auto id = ids.file_vertex(flat.region.source_vertices[v])) {
                auto& [count, place] = found[*id];
                ++count;
                place = flat.chart.uv[v];
            }
        }
        return found;
    };
    const auto in_b = places(b, b_ids);
    double most = 0.0;
    for (const auto& [id, place] : places(a, a_ids)) {
        const auto other = in_b.find(id);
        if (place.first != 1 || other == in_b.end() || other->second.first != 1) continue;
        most = std::max(most, (place.second - other->second.second).norm());
    }
    return most;
}

}  // namespace

Session::Session(std::string model, const FlattenOptions& options, Progress& progress)
    : model_(std::move(model)), options_(options) {
    ShownApart asked = shown_apart(options.request);
    auto read_model = read(asked.request, progress);
    state_ = begun(std::move(asked), std::move(read_model), nullptr, progress);
}

Session::~Session() = default;

const FlattenResult& Session::pattern() const {
    return state_->result;
}
const std::vector<ShownCurve>& Session::curves() const {
    return state_->curves;
}
const SurfaceMesh& Session::surface() const {
    return state_->model->surface;
}
PatternMap& Session::map() {
    return *state_->map;
}

std::shared_ptr<Session::Model> Session::read(const Request& request, Progress& progress) const {
    FlattenOptions options = options_;
    options.request = request;
    return std::make_shared<Model>(read_model(model_, options, progress).surface);
}

Plan Session::plan_of(Model& model, const Request& request, const Progress& progress) const {
    if (!is_bare(model.surface, request)) return make_plan(model.surface, request, std::nullopt);
    if (!model.landmarks)
        model.landmarks = find_landmarks(model.surface, progress, options_.threads);
    return make_plan(model.surface, request, model.landmarks);
}

std::vector<SurfaceLine> Session::shown_lines(const State& state, const ShownApart& asked) {
    const Model& model = *state.model;
    std::vector<CurveSource> sources = asked.shown;
    std::stable_sort(sources.begin(), sources.end(),
                     [](const auto& a, const auto& b) { return turn(a.form) < turn(b.form); });
    auto lines =
        locate_more_curves(model.search, model.surface, state.lines, sources, asked.points);
    std::sort(lines.begin(), lines.end(),
              [](const SurfaceLine& a, const SurfaceLine& b) { return a.name < b.name; });
    return lines;
}

void Session::show(State& state, const std::vector<SurfaceLine>& lines) {
    state.curves.clear();
    for (const SurfaceLine& line : lines)
        state.curves.push_back(shown_curve(state.model->surface, line, *state.map));
}

void Session::solve_regions(State& state, const State* before, Progress& progress) const {
    const Prepared& prepared = state.prepared;
    std::vector<Start> starts;
    if (before != nullptr && is_energy(prepared.plan.request.method.name))
        starts = carried_starts(prepared.regions, before->result);
    Solution solution;
    try {
        if (starts.empty()) starts = start_charts(prepared, options_.threads, progress);
        solution = solve(prepared, std::move(starts), options_, progress, &state.warm);
    } catch (const Error& error) {
        // What is out of reach from a carried start need not be so from one of its own.
        if (before == nullptr || error.code() == ErrorCode::canceled) throw;
        return solve_regions(state, nullptr, progress);
    }
    progress.reach(Stage::measure, 0.9, 1.0);
    state.result = assembled(prepared, std::move(solution), options_);
}

std::unique_ptr<Session::State> Session::begun(ShownApart asked, std::shared_ptr<Model> model,
                                               const State* before, Progress& progress) const {
    Stopwatch total, lap;
    auto state = std::make_unique<State>();
    state->asked = std::move(asked);
    state->model = std::move(model);
    Plan plan = plan_of(*state->model, state->asked.request, progress);
    const SurfaceMesh& surface = state->model->surface;
    state->lines = locate_more_curves(state->model->search, surface, {}, plan.request.curves,
                                      plan.request.points);
    state->prepared = prepare(surface, std::move(plan), progress);
    Timing timing{0.0, lap.lap()};
    progress.reach(Stage::parameterize, 0.3, 0.9);
    solve_regions(*state, before, progress);
    timing.constrain_ms = lap.lap();  // with the starts and the measures
    timing.total_ms = total.lap();
    state->result.timing = timing;
    state->map = std::make_shared<PatternMap>(pieces_of(state->result));
    show(*state, shown_lines(*state, state->asked));
    return state;
}

void Session::change_pattern(ShownApart asked, Progress& progress) {
    Stopwatch total, lap;
    State& state = *state_;
    const std::vector<SurfaceLine> lines = shown_lines(state, asked);
    Prepared next = state.prepared;
    ask(next, plan_of(*state.model, asked.request, progress));
    Timing timing{0.0, lap.lap()};
    progress.reach(Stage::constrain, 0.5, 0.9);
    WarmGroups left;
    auto solution = solve_again(next, options_, progress, state.warm);
    const bool is_warm = solution.has_value();
    if (!is_warm)
        solution =
            solve(next, start_charts(next, options_.threads, progress), options_, progress, &left);
    const bool is_settled = took_few_steps(*solution);
    timing.constrain_ms = lap.lap();
    progress.reach(Stage::measure, 0.9, 1.0);
    FlattenResult result = assembled(next, std::move(*solution), options_);
    timing.total_ms = total.lap();
    result.timing = timing;
    state.map->move_to(charts_of(result));
    show(state, lines);
    state.prepared = std::move(next);
    state.result = std::move(result);
    if (!is_warm) state.warm = std::move(left);
    state.asked = std::move(asked);
    is_settled_ = is_settled;
}

Reach Session::change(const Request& request, Progress& progress) {
    ShownApart asked = shown_apart(request);
    const Reach reach = reach_of_change(state_->asked, asked);
    switch (reach) {
        case Reach::nothing: break;
        case Reach::curves:
            show(*state_, shown_lines(*state_, asked));
            state_->asked = std::move(asked);
            break;
        case Reach::pattern: change_pattern(std::move(asked), progress); break;
        case Reach::regions:
            state_ = begun(std::move(asked), state_->model, state_.get(), progress);
            break;
        case Reach::model: {
            auto model = read(asked.request, progress);
            state_ = begun(std::move(asked), std::move(model), nullptr, progress);
            break;
        }
    }
    options_.request = request;
    return reach;
}

void Session::settle(const Progress& progress) {
    if (is_settled_) return;
    refresh(state_->prepared, options_, progress, state_->warm);
    is_settled_ = true;
}

double Session::difference_from_job(Progress& progress) const {
    const FlattenResult job = flatten(model_, options_, progress);
    double most = 0.0;
    for (const FlatRegion& ours : state_->result.regions) {
        const auto theirs = std::find_if(
            job.regions.begin(), job.regions.end(),
            [&](const FlatRegion& flat) { return flat.region.name == ours.region.name; });
        if (theirs == job.regions.end()) continue;
        most = std::max(most, difference(ours, state_->result.sources, *theirs, job.sources));
    }
    return most;
}

}  // namespace lastflat
