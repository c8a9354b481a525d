// Threads that serve connections, and the bounded queues in front of them.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
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
    std::string early_body;           ///< what arrived behind the head
    Clock::time_point begun{};        ///< when a thread took it
    std::optional<Response> refused;  ///< the answer, if it is not served
};

struct PoolLimits {
    std::size_t serving = 1;           ///< connections served at once
    std::size_t of_client = 1;         ///< of them, of one client
    std::size_t waiting = 0;           ///< seats in the waiting room, beside those served
    std::size_t queued = 0;            ///< connections that wait to be served
    std::size_t queued_of_client = 1;  ///< of them, of one client
};

/// A client has its share of the places, and the next free place goes to the client that has the
/// fewest: whatever one does, others are served.
class ConnectionPool {
public:
    /// Tells whom the connection counts for. One that it refuses counts for nobody.
    using Identify = std::function<std::string(VettedConnection&)>;
    /// The room is where the connection's handler may wait.
    using Serve = std::function<void(VettedConnection, WaitingRoom& room)>;
    /// The answer for a client that has too many connections waiting.
    using Refuse = std::function<Response(const Request&)>;

    /// Starts the threads, which call the three; what one throws ends that connection.
    ConnectionPool(const PoolLimits& limits, Identify identify, Serve serve, Refuse refuse);
    ~ConnectionPool() { finish(); }
    ConnectionPool(const ConnectionPool&) = delete;
    ConnectionPool& operator=(const ConnectionPool&) = delete;

    /// Queues the connection, or leaves it untouched and returns false if the queue is full.
    [[nodiscard]] bool offer(VettedConnection& connection);

    /// Serves what is queued, then ends the threads.
    void finish();

private:
    struct Client {
        std::size_t serving = 0, waiting = 0;
        std::deque<VettedConnection> queue;
        std::uint64_t asked = 0;  ///< when the first of the queue came to be the first
    };
    using Clients = std::map<std::string, Client>;
    class Place;

    void work();
    void identify_one(std::unique_lock<std::mutex>& lock);
    void serve_one(std::unique_lock<std::mutex>& lock, Clients::iterator client);
    /// False: the client has too many waiting; the connection is untouched.
    [[nodiscard]] bool queue(VettedConnection& connection, const std::string& name);
    /// Whose turn it is; the end: nobody's.
    [[nodiscard]] Clients::iterator next();
    void drop_if_idle(Clients::iterator client);

    const PoolLimits limits_;
    const Identify identify_;
    const Serve serve_;
    const Refuse refuse_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<VettedConnection> arrived_;  ///< nobody's yet
    Clients clients_;
    std::size_t queued_ = 0, serving_ = 0, waiting_ = 0, identifying_ = 0;
    std::uint64_t turns_ = 0;
    bool finishing_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace lastflat::http
