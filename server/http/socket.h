// Waiting for a connected socket against a deadline.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>

#include "server/support/descriptor.h"

namespace lastflat::http {

using Clock = std::chrono::steady_clock;

using Socket = server::Descriptor;

/// When the server wants all connections to be over: later than anything until it stops.
class StopTime {
public:
    void set(Clock::time_point time) { ticks_ = time.time_since_epoch().count(); }
    [[nodiscard]] Clock::time_point get() const {
        return Clock::time_point(Clock::duration(ticks_.load()));
    }

private:
    std::atomic<Clock::rep> ticks_{Clock::time_point::max().time_since_epoch().count()};
};

enum class SocketEvent { readable, writable };

/// Waits until the socket can be read or written; false once `deadline` or `stop_time` is over.
[[nodiscard]] bool wait_for(int fd, SocketEvent event, Clock::time_point deadline,
                            const StopTime& stop_time);

/// Makes an accepted socket non-blocking, closed on exec, and without Nagle's delay.
void prepare_accepted(int fd);

/// A client that has closed its side is gone: what it sent is then an end, not bytes.
[[nodiscard]] bool has_hung_up(int fd);

/// The peer's address without its port; empty if it is gone.
[[nodiscard]] std::string peer_address(int fd);

}  // namespace lastflat::http
