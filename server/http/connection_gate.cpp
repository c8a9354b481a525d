#include "server/http/connection_gate.h"

#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <system_error>
#include <utility>

#include "server/http/head.h"

namespace lastflat::http {
namespace {

/// How long a client that does not hang up may still read its answer.
constexpr std::chrono::milliseconds linger_time{1000};
/// How much of what it still sends is read before it has to wait.
constexpr std::size_t most_drained = 64u << 10;
constexpr std::size_t read_step = 16u << 10;

/// Every waiting connection takes a descriptor; some must be left for everything else.
std::size_t most_connections(const ServerLimits& limits) {
    rlimit files{};
    if (::getrlimit(RLIMIT_NOFILE, &files) != 0 || files.rlim_cur == RLIM_INFINITY) {
        return limits.waiting_connections;
    }
    const auto descriptors = static_cast<std::size_t>(files.rlim_cur);
    const std::size_t others = descriptors / 8 + limits.connections + limits.queued_requests + 64;
    const std::size_t room = descriptors > others + 16 ? descriptors - others : 16;
    return std::min(limits.waiting_connections, room);
}

bool is_temporary(int error) {
    return error == EAGAIN || error == EWOULDBLOCK || error == EINTR;
}

}  // namespace

ConnectionGate::ConnectionGate(const ServerLimits& limits, HeadHandler on_head,
                               RefusalWriter write_refusal)
    : limits_(limits),
      most_connections_(most_connections(limits)),
      on_head_(std::move(on_head)),
      write_refusal_(std::move(write_refusal)),
      epoll_(server::checked(::epoll_create1(EPOLL_CLOEXEC), "epoll_create1")),
      waker_(server::checked(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK), "eventfd")) {
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.ptr = nullptr;  // the waker; connections have their address here
    if (::epoll_ctl(epoll_.fd(), EPOLL_CTL_ADD, waker_.fd(), &event) != 0) {
        throw std::system_error(errno, std::generic_category(), "epoll_ctl");
    }
    thread_ = std::thread([this] { watch(); });
}

void ConnectionGate::admit(Socket socket, std::string bytes) {
    arrive({std::move(socket), State::reading, std::move(bytes)});
}

void ConnectionGate::linger(Socket socket) {
    ::shutdown(socket.fd(), SHUT_WR);
    arrive({std::move(socket), State::lingering, {}});
}

void ConnectionGate::arrive(Arrival arrival) {
    {
        const std::lock_guard lock(mutex_);
        arrivals_.push_back(std::move(arrival));
    }
    wake();
}

void ConnectionGate::drop_unfinished() {
    dropping_unfinished_ = true;
    wake();
}

void ConnectionGate::finish() {
    dropping_unfinished_ = true;
    finishing_ = true;
    wake();
    if (thread_.joinable()) thread_.join();
}

void ConnectionGate::wake() const {
    const std::uint64_t one = 1;
    // Can only fail if the counter is full, and then the thread is awake anyway.
    [[maybe_unused]] const ssize_t written = ::write(waker_.fd(), &one, sizeof one);
}

void ConnectionGate::watch() {
    while (true) {
        try {
            // Read before the arrivals are taken: what arrived before `finish` is then seen.
            const bool finishing = finishing_;
            watch_once();
            if (finishing && reading_.empty() && lingering_.empty()) return;
        } catch (...) {
            // Out of memory, most likely. The oldest make room; the service goes on.
            if (!reading_.empty()) drop(reading_.front());
        }
    }
}

void ConnectionGate::watch_once() {
    std::array<epoll_event, 64> events{};
    const int count = ::epoll_wait(epoll_.fd(), events.data(), static_cast<int>(events.size()),
                                   milliseconds_to_wait());
    // In this loop a connection may end only itself, or a later event would point nowhere.
    for (int i = 0; i < count; ++i) {
        auto* connection = static_cast<Connection*>(events[static_cast<std::size_t>(i)].data.ptr);
        if (connection) {
            on_ready(*connection);
        } else {
            std::uint64_t wakes = 0;
            [[maybe_unused]] const ssize_t got = ::read(waker_.fd(), &wakes, sizeof wakes);
        }
    }
    take_arrivals();
    if (dropping_unfinished_) {
        while (!reading_.empty()) drop(reading_.front());
    }
    drop_overdue();
    make_room();
}

int ConnectionGate::milliseconds_to_wait() const {
    auto next = Clock::time_point::max();
    if (!reading_.empty()) next = std::min(next, reading_.front().deadline);
    if (!lingering_.empty()) next = std::min(next, lingering_.front().deadline);
    if (next == Clock::time_point::max()) return finishing_ ? 0 : -1;
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(next - Clock::now()).count();
    return static_cast<int>(std::clamp<std::int64_t>(left, 0, 60'000));
}

void ConnectionGate::take_arrivals() {
    std::vector<Arrival> arrivals;
    {
        const std::lock_guard lock(mutex_);
        arrivals.swap(arrivals_);
    }
    for (Arrival& arrival : arrivals) add(std::move(arrival));
}

void ConnectionGate::add(Arrival arrival) {
    const bool reading = arrival.state == State::reading;
    std::list<Connection>& list = reading ? reading_ : lingering_;
    const auto time = reading ? limits_.head_time : linger_time;
    const auto entry = list.emplace(list.end());
    entry->socket = std::move(arrival.socket);
    entry->state = arrival.state;
    entry->deadline = Clock::now() + time;
    entry->self = entry;
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.ptr = &*entry;
    entry->bytes = std::move(arrival.bytes);
    if (::epoll_ctl(epoll_.fd(), EPOLL_CTL_ADD, entry->socket.fd(), &event) != 0)
        return drop(*entry);
    if (reading && !entry->bytes.empty()) look_for_head(*entry, 0);
}

void ConnectionGate::on_ready(Connection& connection) {
    if (connection.state == State::reading) {
        read_head(connection);
    } else {
        drain(connection);
    }
}

void ConnectionGate::read_head(Connection& connection) {
    std::array<char, read_step> step;
    const ssize_t got = ::recv(connection.socket.fd(), step.data(), step.size(), 0);
    if (got < 0 && is_temporary(errno)) return;
    if (got <= 0) return drop(connection);  // gone before it asked for anything
    const std::size_t searched = connection.bytes.size();
    connection.bytes.append(step.data(), static_cast<std::size_t>(got));
    look_for_head(connection, searched);
}

void ConnectionGate::look_for_head(Connection& connection, std::size_t searched) {
    const auto head_size = head_length(connection.bytes, searched);
    if (head_size ? *head_size <= limits_.head_bytes
                  : connection.bytes.size() < limits_.head_bytes) {
        if (head_size) hand_on(connection, *head_size);
        return;
    }
    if (connection.bytes.find('\n') >= limits_.head_bytes) {  // or there is none
        return refuse(connection, api::Refusal("target_too_long", "The request line is too long."));
    }
    refuse(connection, api::Refusal("head_too_large",
                                    "The request line and headers may have at most " +
                                        std::to_string(limits_.head_bytes) + " bytes together."));
}

void ConnectionGate::hand_on(Connection& connection, std::size_t head_size) {
    const int fd = connection.socket.fd();
    ::epoll_ctl(epoll_.fd(), EPOLL_CTL_DEL, fd, nullptr);
    const auto reply = on_head_(connection.socket, connection.bytes, head_size);
    if (!connection.socket.is_open()) {
        reading_.erase(connection.self);
        return;
    }
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.ptr = &connection;
    if (!reply || ::epoll_ctl(epoll_.fd(), EPOLL_CTL_ADD, fd, &event) != 0) return drop(connection);
    answer(connection, *reply);
}

void ConnectionGate::refuse(Connection& connection, const api::Refusal& why) {
    answer(connection, write_refusal_({why, "", asks_for_head_only(connection.bytes)}));
}

void ConnectionGate::answer(Connection& connection, const std::string& bytes) {
    const int fd = connection.socket.fd();
    // An answer of this kind is small and the first on its socket, so it fits the send buffer.
    const ssize_t sent = ::send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent != static_cast<ssize_t>(bytes.size())) return drop(connection);
    ::shutdown(fd, SHUT_WR);
    connection.state = State::lingering;
    connection.deadline = Clock::now() + linger_time;
    connection.bytes = std::string();
    lingering_.splice(lingering_.end(), reading_, connection.self);
}

void ConnectionGate::drain(Connection& connection) {
    std::array<char, read_step> step;
    const ssize_t got = ::recv(connection.socket.fd(), step.data(), step.size(), 0);
    if (got < 0 && is_temporary(errno)) return;
    if (got <= 0) return drop(connection);
    connection.drained += static_cast<std::size_t>(got);
    if (connection.drained < most_drained) return;
    // Enough. Left unread, the rest stops the sender, who can still read the answer until the
    // deadline; only a hang-up is watched for (it is always reported).
    epoll_event event{};
    event.data.ptr = &connection;
    ::epoll_ctl(epoll_.fd(), EPOLL_CTL_MOD, connection.socket.fd(), &event);
}

void ConnectionGate::drop(Connection& connection) {
    std::list<Connection>& list = connection.state == State::reading ? reading_ : lingering_;
    // Closing the socket would not take it out of epoll while a process that is just being started
    // still holds a copy of it.
    ::epoll_ctl(epoll_.fd(), EPOLL_CTL_DEL, connection.socket.fd(), nullptr);
    list.erase(connection.self);
}

void ConnectionGate::drop_overdue() {
    const auto now = Clock::now();
    while (!lingering_.empty() && lingering_.front().deadline <= now) drop(lingering_.front());
    while (!reading_.empty() && reading_.front().deadline <= now) {
        Connection& connection = reading_.front();
        if (connection.bytes.empty()) {
            drop(connection);
        } else {
            refuse(connection,
                   api::Refusal("head_too_slow",
                                "The request's headers did not arrive in time. Send them "
                                "at once."));
        }
    }
}

void ConnectionGate::make_room() {
    while (reading_.size() + lingering_.size() > most_connections_) {
        std::list<Connection>& longer = lingering_.size() > reading_.size() ? lingering_ : reading_;
        drop(longer.front());
    }
}

}  // namespace lastflat::http
