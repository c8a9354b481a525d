#include "server/http/connection_pool.h"

#include <utility>

namespace lastflat::http {

ConnectionPool::ConnectionPool(std::size_t serving, std::size_t waiting, std::size_t most_queued,
                               Serve serve)
    : most_serving_(serving),
      most_waiting_(waiting),
      most_queued_(most_queued),
      serve_(std::move(serve)) {
    try {
        for (std::size_t i = 0; i < serving + waiting; ++i)
            threads_.emplace_back([this] { work(); });
    } catch (...) {
        finish();
        throw;
    }
}

bool ConnectionPool::offer(VettedConnection& connection) {
    {
        const std::lock_guard lock(mutex_);
        const std::size_t idle = most_serving_ > serving_ ? most_serving_ - serving_ : 0;
        if (finishing_ || queue_.size() >= most_queued_ + idle) return false;
        queue_.push_back(std::move(connection));
    }
    changed_.notify_one();
    return true;
}

bool ConnectionPool::enter() {
    {
        const std::lock_guard lock(mutex_);
        if (waiting_ == most_waiting_) return false;
        ++waiting_;
        --serving_;
    }
    changed_.notify_one();
    return true;
}

void ConnectionPool::leave() {
    const std::lock_guard lock(mutex_);
    --waiting_;
    ++serving_;
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
        changed_.wait(lock, [this] {
            return (finishing_ && queue_.empty()) || (!queue_.empty() && serving_ < most_serving_);
        });
        if (queue_.empty()) return;
        VettedConnection connection = std::move(queue_.front());
        queue_.pop_front();
        ++serving_;
        lock.unlock();
        try {
            serve_(std::move(connection));
        } catch (...) {
            // The connection closes itself; the thread goes on.
        }
        lock.lock();
        --serving_;
        // One of those that wait for a seat may go on; at the end, all must look.
        if (finishing_)
            changed_.notify_all();
        else
            changed_.notify_one();
    }
}

}  // namespace lastflat::http
