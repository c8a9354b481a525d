#include "core/progress.h"

namespace lastflat {

void Progress::reach(Stage stage, double fraction, double next) {
    throw_if_canceled();
    const std::scoped_lock lock(telling_);
    stage_ = stage;
    fraction_ = fraction;
    next_ = next;
    told_ = Clock::now().time_since_epoch().count();
    if (observer_) observer_(stage, fraction);
}

void Progress::near_next() const {
    constexpr Clock::duration pause = std::chrono::milliseconds(250);
    constexpr double share = 1.0 / 16.0;  // of what is left of the stage
    const Clock::rep now = Clock::now().time_since_epoch().count();
    Clock::rep told = told_;
    if (now - told < pause.count() || !told_.compare_exchange_strong(told, now)) return;
    const std::scoped_lock lock(telling_);
    fraction_ = fraction_ + share * (next_ - fraction_);
    observer_(stage_, fraction_);
}

}  // namespace lastflat
