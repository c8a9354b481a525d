#include "server/http/connection_pool.h"

#include <utility>

namespace lastflat::http {

ConnectionPool::ConnectionPool(std::size_t threads, std::size_t most_queued, Serve serve)
    : most_queued_(most_queued), serve_(std::move(serve)) {
    // A thread that is not yet running counts as idle, or the first requests would be refused.
    idle_threads_ = threads;
    try {
        for (std::size_t i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
    } catch (...) {
        finish();
        throw;
    }
}

bool ConnectionPool::offer(VettedConnection& connection) {
    {
        const std::lock_guard lock(mutex_);
        if (finishing_ || queue_.size() >= most_queued_ + idle_threads_) return false;
        queue_.push_back(std::move(connection));
    }
    changed_.notify_one();
    return true;
}

void ConnectionPool::finish() {
    {
        const std::lock_guard lock(mutex_);
        finishing_ = true;
    }
    changed_.notify_all();
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
}

void ConnectionPool::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return finishing_ || !queue_.empty(); });
        if (queue_.empty()) return;
        VettedConnection connection = std::move(queue_.front());
        queue_.pop_front();
        --idle_threads_;
        lock.unlock();
        try {
            serve_(std::move(connection));
        } catch (...) {
            // The connection closes itself; the thread goes on.
        }
        lock.lock();
        ++idle_threads_;
    }
}

}  // namespace lastflat::http
