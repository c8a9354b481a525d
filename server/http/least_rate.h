// How slow a client may be.
#pragma once

#include "server/http/http.h"
#include "server/http/socket.h"

namespace lastflat::http {

/// Enough bytes have to move in every window of time: what moved before buys nobody a rest.
class LeastRate {
public:
    explicit LeastRate(const ServerLimits& limits)
        : enough_(static_cast<double>(limits.least_bytes_per_second) *
                  std::chrono::duration<double>(limits.rate_window).count()),
          window_(limits.rate_window) {}

    void restart() {
        begin_ = Clock::now();
        moved_ = 0.0;
    }
    void note(std::size_t bytes) {
        moved_ += static_cast<double>(bytes);
        if (moved_ >= enough_) restart();
    }
    /// By when, unless enough has moved, it is too slow.
    [[nodiscard]] Clock::time_point deadline() const { return begin_ + window_; }

private:
    const double enough_;
    const std::chrono::milliseconds window_;
    Clock::time_point begin_ = Clock::now();
    double moved_ = 0.0;
};

}  // namespace lastflat::http
