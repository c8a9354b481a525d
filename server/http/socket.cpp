#include "server/http/socket.h"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>

namespace lastflat::http {

bool wait_for(int fd, SocketEvent event, Clock::time_point deadline, const StopTime& stop_time) {
    // The stop time may move while we wait, so it is looked at several times a second.
    constexpr std::chrono::milliseconds longest_wait{100};
    while (true) {
        const auto left = std::min(deadline, stop_time.get()) - Clock::now();
        if (left <= Clock::duration::zero()) return false;
        const auto wait = std::min<Clock::duration>(left, longest_wait);
        const auto milliseconds = std::chrono::ceil<std::chrono::milliseconds>(wait).count();
        pollfd watched{fd, static_cast<short>(event == SocketEvent::readable ? POLLIN : POLLOUT),
                       0};
        const int ready = ::poll(&watched, 1, static_cast<int>(milliseconds));
        if (ready > 0) return true;  // also for an error: the next read or write reports it
        if (ready < 0 && errno != EINTR) return false;
    }
}

void prepare_accepted(int fd) {
    ::fcntl(fd, F_SETFL, ::fcntl(fd, F_GETFL) | O_NONBLOCK);
    ::fcntl(fd, F_SETFD, FD_CLOEXEC);
    const int on = 1;
    ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
}

bool has_hung_up(int fd) {
    pollfd watched{fd, POLLRDHUP, 0};
    return ::poll(&watched, 1, 0) > 0;
}

std::string peer_address(int fd) {
    sockaddr_storage address{};
    socklen_t length = sizeof address;
    std::array<char, NI_MAXHOST> host{};
    auto* plain = reinterpret_cast<sockaddr*>(&address);
    if (::getpeername(fd, plain, &length) != 0 ||
        ::getnameinfo(plain, length, host.data(), host.size(), nullptr, 0, NI_NUMERICHOST) != 0) {
        return {};
    }
    return host.data();
}

}  // namespace lastflat::http
