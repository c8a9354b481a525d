// What is kept warm between one question and the next.
#pragma once

#include <memory>

#include "core/result.h"
#include "core/session/change.h"
#include "core/session/shown_curve.h"
#include "core/solve.h"

namespace lastflat {

/// A last and its pattern, for as long as somebody changes the request. Curves that are only shown
/// (`is_shown_only`) do not become edges of the surface here, as they do in a job; they are
/// followed on it and mapped.
///
/// A change does only what it reaches. One of the pattern begins at the optimum before, with its
/// multipliers and its last factor, and ends within 1e-5 mm of the optimum; one of the regions at
/// the charts before, carried over. Without contact the optimum is the one that a job finds; with
/// contact it may be another.
class Session {
public:
    /// Does all that `flatten` does. Throws: Error, as that does.
    Session(std::string model, const FlattenOptions& options, Progress& progress);
    ~Session();

    /// Asks something else from now on. Returns how far that reached.
    /// Throws: Error, as `flatten` does; the session is then as it was.
    Reach change(const Request& request, Progress& progress);

    /// For when nobody waits: makes the next change quick. Nothing to be done is nothing done.
    /// Throws: Error{canceled}; nothing is lost.
    void settle(const Progress& progress);

    [[nodiscard]] const FlattenResult& pattern() const;
    /// In the order of their names.
    [[nodiscard]] const std::vector<ShownCurve>& curves() const;
    /// The surface without any curve in it: vertices of the file, welded.
    [[nodiscard]] const SurfaceMesh& surface() const;
    [[nodiscard]] PatternMap& map();

    /// How far a vertex of the file lies at most from where `flatten`, asked the same, puts it, mm.
    /// Throws: Error, as that does.
    [[nodiscard]] double difference_from_job(Progress& progress) const;

private:
    struct Model;
    struct State;
    [[nodiscard]] std::shared_ptr<Model> read(const Request& request, Progress& progress) const;
    [[nodiscard]] Plan plan_of(Model& model, const Request& request,
                               const Progress& progress) const;
    /// From the model to the pattern; `before`: where to start from, or null.
    [[nodiscard]] std::unique_ptr<State> begun(ShownApart asked, std::shared_ptr<Model> model,
                                               const State* before, Progress& progress) const;
    void solve_regions(State& state, const State* before, Progress& progress) const;
    void change_pattern(ShownApart asked, Progress& progress);
    [[nodiscard]] static std::vector<SurfaceLine> shown_lines(const State& state,
                                                              const ShownApart& asked);
    static void show(State& state, const std::vector<SurfaceLine>& lines);

    std::string model_;
    FlattenOptions options_;  ///< its request is what is asked now
    std::unique_ptr<State> state_;
    bool is_settled_ = true;
};

}  // namespace lastflat
