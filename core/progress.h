// How far a job is, and whether it is still wanted. Shared between the thread that works and those
// that watch.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <string_view>

#include "core/error.h"

namespace lastflat {

enum class Stage { load, weld, landmarks, cut, parameterize, constrain, measure, done };

[[nodiscard]] constexpr std::string_view name(Stage stage) {
    switch (stage) {
        case Stage::load: return "load";
        case Stage::weld: return "weld";
        case Stage::landmarks: return "landmarks";
        case Stage::cut: return "cut";
        case Stage::parameterize: return "parameterize";
        case Stage::constrain: return "constrain";
        case Stage::measure: return "measure";
        case Stage::done: return "done";
    }
    return "unknown";
}

/// One working thread reaches stages; it and those that help it check. Read from any, and `cancel`
/// may be called from any thread.
class Progress {
public:
    /// Told of every `reach`, and now and then by `check`; one call at a time.
    using Observer = std::function<void(Stage stage, double fraction)>;

    explicit Progress(Observer observer = {}) : observer_(std::move(observer)) {}

    /// Says that `stage` has begun and stands at `fraction` in [0, 1] of the whole job; the next
    /// one will begin at `next`.
    /// Throws: Error{canceled} if the job was canceled.
    void reach(Stage stage, double fraction, double next);

    /// Called in every long loop. Nobody knows how many steps a stage takes, so while it goes on
    /// the fraction nears that of the next stage, and never gets there.
    /// Throws: Error{canceled} if the job was canceled.
    void check() const {
        throw_if_canceled();
        if (observer_) near_next();
    }
    void cancel() { canceled_ = true; }

    [[nodiscard]] Stage stage() const { return stage_; }
    [[nodiscard]] double fraction() const { return fraction_; }

private:
    using Clock = std::chrono::steady_clock;
    void throw_if_canceled() const {
        if (canceled_) throw Error(ErrorCode::canceled, "the job was canceled");
    }
    void near_next() const;

    const Observer observer_;
    std::atomic<Stage> stage_{Stage::load};
    std::atomic<bool> canceled_{false};
    mutable std::atomic<double> fraction_{0.0};
    mutable std::mutex telling_;
    double next_ = 0.0;
    mutable std::atomic<Clock::rep> told_{0};  ///< when
};

}  // namespace lastflat
