// Threads that serve connections, and the bounded queue in front of them.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "server/http/head.h"
#include "server/http/socket.h"

namespace lastflat::http {

/// A connection whose head is complete and vetted.
struct VettedConnection {
    Socket socket;
    Head head;
    std::string early_body;  ///< what arrived behind the head
};

class ConnectionPool : public WaitingRoom {
public:
    using Serve = std::function<void(VettedConnection)>;

    /// Starts the threads. `serve` runs on them, `serving` at once beside `waiting` that wait; what
    /// it throws is dropped.
    ConnectionPool(std::size_t serving, std::size_t waiting, std::size_t most_queued, Serve serve);
    ~ConnectionPool() override { finish(); }
    ConnectionPool(const ConnectionPool&) = delete;
    ConnectionPool& operator=(const ConnectionPool&) = delete;

    /// Queues the connection, or leaves it untouched and returns false if the queue is full.
    [[nodiscard]] bool offer(VettedConnection& connection);

    [[nodiscard]] bool enter() override;
    void leave() override;

    /// Serves what is queued, then ends the threads.
    void finish();

private:
    void work();

    const std::size_t most_serving_, most_waiting_, most_queued_;
    const Serve serve_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<VettedConnection> queue_;
    std::size_t serving_ = 0, waiting_ = 0;
    bool finishing_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace lastflat::http
