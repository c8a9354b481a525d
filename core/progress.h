// How far a job is, and whether it is still wanted. Shared between the thread that works and those
// that watch.
#pragma once

#include <atomic>
#include <functional>
#include <string_view>

#include "core/error.h"

namespace lastflat {

enum class Stage { load, weld, cut, parameterize, constrain, measure, done };

[[nodiscard]] constexpr std::string_view name(Stage stage) {
    switch (stage) {
        case Stage::load: return "load";
        case Stage::weld: return "weld";
        case Stage::cut: return "cut";
        case Stage::parameterize: return "parameterize";
        case Stage::constrain: return "constrain";
        case Stage::measure: return "measure";
        case Stage::done: return "done";
    }
    return "unknown";
}

/// Written by one working thread, read by any; `cancel` may be called from any thread.
class Progress {
public:
    /// Told of every `reach`, on the working thread.
    using Observer = std::function<void(Stage stage, double fraction)>;

    explicit Progress(Observer observer = {}) : observer_(std::move(observer)) {}

    /// Says that `stage` has begun and stands at `fraction` in [0, 1] of the whole job.
    /// Throws: Error{canceled} if the job was canceled.
    void reach(Stage stage, double fraction) {
        stage_ = stage;
        fraction_ = fraction;
        check();
        if (observer_) observer_(stage, fraction);
    }
    /// Throws: Error{canceled} if the job was canceled. Called in every long loop.
    void check() const {
        if (canceled_) throw Error(ErrorCode::canceled, "the job was canceled");
    }
    void cancel() { canceled_ = true; }

    [[nodiscard]] Stage stage() const { return stage_; }
    [[nodiscard]] double fraction() const { return fraction_; }

private:
    const Observer observer_;
    std::atomic<Stage> stage_{Stage::load};
    std::atomic<double> fraction_{0.0};
    std::atomic<bool> canceled_{false};
};

}  // namespace lastflat
