// A lock for many, or for one alone, that neither can keep from the other for ever.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>

namespace lastflat::server {

/// A lock that many may share, and that who wants it alone gets as soon as those who have it leave:
/// the standard's lets new ones in for ever.
class FairGate {
public:
    void lock_shared() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return !alone_ && waiting_ == 0; });
        ++sharing_;
    }
    void unlock_shared() {
        const std::scoped_lock lock(mutex_);
        if (--sharing_ == 0) changed_.notify_all();
    }
    void lock() {
        std::unique_lock lock(mutex_);
        ++waiting_;
        changed_.wait(lock, [&] { return !alone_ && sharing_ == 0; });
        --waiting_;
        alone_ = true;
    }
    void unlock() {
        const std::scoped_lock lock(mutex_);
        alone_ = false;
        changed_.notify_all();
    }

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    std::size_t sharing_ = 0, waiting_ = 0;
    bool alone_ = false;
};

}  // namespace lastflat::server
