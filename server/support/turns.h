// Places to do something in, for which owners take turns.
#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <mutex>
#include <string>

#include "server/support/scope_exit.h"

namespace lastflat::server {

/// Whoever waits gets a free place in turn: first who has the fewest, then who was served longest
/// ago, then who came first. Safe from any thread.
class Turns {
public:
    explicit Turns(std::size_t places) : free_(places) {}

    /// A place; false: `ends` said so before there was one. It is asked ten times a second.
    [[nodiscard]] bool enter(const std::string& owner, const std::function<bool()>& ends) {
        std::unique_lock lock(mutex_);
        const auto self = waiting_.insert(waiting_.end(), owner);
        // Whatever happens: nobody waits behind one who has left.
        const ScopeExit at_end([&] {
            waiting_.erase(self);
            changed_.notify_all();
        });
        while (free_ == 0 || next() != self) {
            lock.unlock();
            const bool over = [&] {
                const ScopeExit again([&] { lock.lock(); });
                return ends();
            }();
            if (over) return false;
            changed_.wait_for(lock, look_every, [&] { return free_ > 0 && next() == self; });
        }
        --free_;
        Owner& served = owners_[owner];
        ++served.places;
        served.turn = ++turns_;
        return true;
    }
    void leave(const std::string& owner) {
        const std::scoped_lock lock(mutex_);
        ++free_;
        --owners_[owner].places;
        // Who has waited longer than anybody's last turn needs none remembered.
        if (waiting_.empty())
            std::erase_if(owners_, [](const auto& o) { return o.second.places == 0; });
        changed_.notify_all();
    }

private:
    static constexpr std::chrono::milliseconds look_every{100};
    struct Owner {
        std::size_t places = 0;
        std::uint64_t turn = 0;
        auto operator<=>(const Owner&) const = default;
    };
    [[nodiscard]] std::list<std::string>::iterator next() {
        return std::min_element(
            waiting_.begin(), waiting_.end(),
            [&](const std::string& a, const std::string& b) { return owners_[a] < owners_[b]; });
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    std::size_t free_;
    std::uint64_t turns_ = 0;
    std::list<std::string> waiting_;  ///< an owner each, in the order of their coming
    std::map<std::string, Owner> owners_;
};

}  // namespace lastflat::server
