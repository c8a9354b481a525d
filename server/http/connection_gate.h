// Holds connections that need no thread: those whose head, the first or the next one, is still
// coming, and those whose last answer is out and whose client has not yet hung up.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "server/http/refusal.h"
#include "server/http/socket.h"

namespace lastflat::http {

/// One thread over epoll; ten thousand idle connections cost it nothing but descriptors.
///
///   admit ──► reading the head ──► handed on, the gate is done with it
///                  │
///                  ├──► refused: answer, then lingering ──► closed
///                  └──► closed, if newer ones need the room
///   linger ─────────────────────────────► lingering ──► closed
class ConnectionGate {
public:
    /// Called on the gate's thread with a socket whose first `head_size` bytes of `bytes` are a
    /// head. Either moves from both, or leaves them and returns the bytes of an answer.
    using HeadHandler = std::function<std::optional<std::string>(Socket& socket, std::string& bytes,
                                                                 std::size_t head_size)>;
    /// The bytes of the answer to a refusal.
    using RefusalWriter = std::function<std::string(const RefusedHead&)>;

    ConnectionGate(const ServerLimits& limits, HeadHandler on_head, RefusalWriter write_refusal);
    ~ConnectionGate() { finish(); }
    ConnectionGate(const ConnectionGate&) = delete;
    ConnectionGate& operator=(const ConnectionGate&) = delete;

    /// Takes a socket that was accepted, or answered and kept alive, with what is already read of
    /// its next head. Any thread.
    void admit(Socket socket, std::string bytes = {});
    /// Takes a socket whose answer is written: closing it at once would take the answer away from
    /// a client that is still sending. Any thread.
    void linger(Socket socket);
    /// From now on, unfinished heads are dropped. Any thread.
    void drop_unfinished();
    /// Waits for the lingering ones, which is bounded, and ends the thread.
    void finish();

private:
    enum class State { reading, lingering };
    struct Connection {
        Socket socket;
        State state = State::reading;
        Clock::time_point deadline;
        std::string bytes;        ///< read so far
        std::size_t drained = 0;  ///< bytes thrown away while lingering
        std::list<Connection>::iterator self;
    };
    struct Arrival {
        Socket socket;
        State state;
        std::string bytes;
    };

    void arrive(Arrival arrival);
    void wake() const;
    void watch();
    void watch_once();
    void take_arrivals();
    void add(Arrival arrival);
    void on_ready(Connection& connection);
    void read_head(Connection& connection);
    void look_for_head(Connection& connection, std::size_t searched);
    void hand_on(Connection& connection, std::size_t head_size);
    void refuse(Connection& connection, const api::Refusal& why);
    void answer(Connection& connection, const std::string& bytes);
    void drain(Connection& connection);
    void drop(Connection& connection);
    void drop_overdue();
    void make_room();
    [[nodiscard]] int milliseconds_to_wait() const;

    const ServerLimits limits_;
    const std::size_t most_connections_;
    const HeadHandler on_head_;
    const RefusalWriter write_refusal_;
    Socket epoll_;
    Socket waker_;
    std::mutex mutex_;
    std::vector<Arrival> arrivals_;  ///< guarded by mutex_
    std::atomic<bool> dropping_unfinished_{false};
    std::atomic<bool> finishing_{false};
    // Each list holds one state, by deadline: the first is the one that has waited longest.
    std::list<Connection> reading_;
    std::list<Connection> lingering_;
    std::thread thread_;
};

}  // namespace lastflat::http
