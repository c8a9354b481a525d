#include "server/http/connection_pool.h"

#include <tuple>
#include <utility>

namespace lastflat::http {
namespace {

/// Whatever the others do, these find out who asks.
constexpr std::size_t identifying_threads = 2;

/// For connections that are refused: nothing waits there.
class NoRoom final : public WaitingRoom {
public:
    bool enter() override { return false; }
    void leave() override {}
};

}  // namespace

/// A client's place while one of its connections is served.
class ConnectionPool::Place final : public WaitingRoom {
public:
    Place(ConnectionPool& pool, Clients::iterator client) : pool_(pool), client_(client) {}

    bool enter() override {
        {
            const std::lock_guard lock(pool_.mutex_);
            if (pool_.waiting_ == pool_.limits_.waiting) return false;
            ++pool_.waiting_;
            --pool_.serving_;
            --client_->second.serving;
            ++client_->second.waiting;
        }
        pool_.changed_.notify_one();
        return true;
    }
    void leave() override {
        const std::lock_guard lock(pool_.mutex_);
        --pool_.waiting_;
        ++pool_.serving_;
        --client_->second.waiting;
        ++client_->second.serving;
    }

private:
    ConnectionPool& pool_;
    const Clients::iterator client_;
};

ConnectionPool::ConnectionPool(const PoolLimits& limits, Identify identify, Serve serve,
                               Refuse refuse)
    : limits_(limits),
      identify_(std::move(identify)),
      serve_(std::move(serve)),
      refuse_(std::move(refuse)) {
    try {
        for (std::size_t i = 0; i < limits.serving + limits.waiting + identifying_threads; ++i)
            threads_.emplace_back([this] { work(); });
    } catch (...) {
        finish();
        throw;
    }
}

bool ConnectionPool::offer(VettedConnection& connection) {
    {
        const std::lock_guard lock(mutex_);
        const std::size_t idle = limits_.serving > serving_ ? limits_.serving - serving_ : 0;
        const std::size_t queued = arrived_.size() + identifying_ + queued_;
        if (finishing_ || queued >= limits_.queued + idle) return false;
        arrived_.push_back(std::move(connection));
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

ConnectionPool::Clients::iterator ConnectionPool::next() {
    auto best = clients_.end();
    if (serving_ >= limits_.serving) return best;
    const auto order = [](const Client& client) {
        return std::tuple(client.serving, client.asked);
    };
    for (auto client = clients_.begin(); client != clients_.end(); ++client) {
        if (client->second.queue.empty() || client->second.serving >= limits_.of_client) continue;
        if (best == clients_.end() || order(client->second) < order(best->second)) best = client;
    }
    return best;
}

/// A thread that is done looks for what to do next, so others are woken for new connections alone,
/// for places that are left for the waiting room, and at the end.
void ConnectionPool::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        auto client = clients_.end();
        changed_.wait(lock, [&] {
            client = next();
            return client != clients_.end() || !arrived_.empty() ||
                   (finishing_ && queued_ == 0 && identifying_ == 0);
        });
        if (client != clients_.end())
            serve_one(lock, client);
        else if (!arrived_.empty())
            identify_one(lock);
        else
            return;
    }
}

void ConnectionPool::identify_one(std::unique_lock<std::mutex>& lock) {
    VettedConnection connection = std::move(arrived_.front());
    arrived_.pop_front();
    ++identifying_;
    lock.unlock();
    try {
        const std::string name = identify_(connection);
        if (!connection.refused && !queue(connection, name))
            connection.refused = refuse_(connection.head.request);
        // Small answers, written at once or not at all: no client can make them wait.
        NoRoom none;
        if (connection.refused) serve_(std::move(connection), none);
    } catch (...) {
        // Out of memory, most likely. The connection closes itself; the thread goes on.
    }
    lock.lock();
    --identifying_;
    if (finishing_) changed_.notify_all();
}

bool ConnectionPool::queue(VettedConnection& connection, const std::string& name) {
    const std::lock_guard lock(mutex_);
    const auto client = clients_.try_emplace(name).first;
    std::deque<VettedConnection>& queue = client->second.queue;
    if (queue.size() >= limits_.queued_of_client) return false;
    if (queue.empty()) client->second.asked = ++turns_;
    queue.push_back(std::move(connection));
    ++queued_;
    return true;
}

void ConnectionPool::serve_one(std::unique_lock<std::mutex>& lock, Clients::iterator client) {
    VettedConnection connection = std::move(client->second.queue.front());
    client->second.queue.pop_front();
    client->second.asked = ++turns_;
    --queued_;
    ++serving_;
    ++client->second.serving;
    Place place(*this, client);
    lock.unlock();
    try {
        serve_(std::move(connection), place);
    } catch (...) {
        // The connection closes itself; the thread goes on.
    }
    lock.lock();
    --serving_;
    --client->second.serving;
    drop_if_idle(client);
    if (finishing_) changed_.notify_all();
}

void ConnectionPool::drop_if_idle(Clients::iterator client) {
    const Client& it = client->second;
    if (it.serving == 0 && it.waiting == 0 && it.queue.empty()) clients_.erase(client);
}

}  // namespace lastflat::http
