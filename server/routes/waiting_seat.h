// A seat to wait in: of the room that all have, and of the share of it that one key may have.
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
    explicit SeatsByKey(std::size_t streams) : free_(streams) {}

    /// False: the key has as many as are left for all others, at most half of all: a few that wait
    /// for everything leave seats for the next. Without keys, whoever asks may have all.
    [[nodiscard]] bool enter(const std::string& key) {
        const std::scoped_lock lock(mutex_);
        const auto own = seats_.find(key);
        const std::size_t seats = own == seats_.end() ? 0 : own->second;
        if (free_ == 0 || (!key.empty() && seats >= free_)) return false;
        --free_;
        ++seats_[key];
        return true;
    }
    void leave(const std::string& key) {
        const std::scoped_lock lock(mutex_);
        ++free_;
        if (--seats_[key] == 0) seats_.erase(key);
    }

private:
    std::mutex mutex_;
    std::size_t free_;
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
