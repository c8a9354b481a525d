// A seat to wait in: of the room that all have, and of the half of it that one key may have.
#pragma once

#include <map>
#include <mutex>
#include <string>

#include "server/http/http.h"

namespace lastflat::server {

/// How many seats each key has. Safe from any thread.
class SeatsByKey {
public:
    /// `streams`: seats in the room.
    explicit SeatsByKey(std::size_t streams) : most_((streams + 1) / 2) {}

    /// False: the key has as many as it may. Without keys, whoever asks may have all.
    [[nodiscard]] bool enter(const std::string& key) {
        const std::scoped_lock lock(mutex_);
        std::size_t& seats = seats_[key];
        if (!key.empty() && seats >= most_) return false;
        ++seats;
        return true;
    }
    void leave(const std::string& key) {
        const std::scoped_lock lock(mutex_);
        if (--seats_[key] == 0) seats_.erase(key);
    }

private:
    const std::size_t most_;
    std::mutex mutex_;
    std::map<std::string, std::size_t> seats_;
};

class WaitingSeat {
public:
    WaitingSeat(SeatsByKey& seats, const http::Request& request)
        : seats_(seats),
          key_(request.principal),
          has_share_(seats_.enter(key_)),
          seat_(has_share_ ? request.waiting_room : nullptr) {}
    ~WaitingSeat() {
        if (has_share_) seats_.leave(key_);
    }
    WaitingSeat(const WaitingSeat&) = delete;
    WaitingSeat& operator=(const WaitingSeat&) = delete;
    /// False: there is none; do not wait.
    [[nodiscard]] bool is_taken() const { return seat_.is_taken(); }

private:
    SeatsByKey& seats_;
    const std::string key_;
    const bool has_share_;
    const http::Seat seat_;
};

}  // namespace lastflat::server
