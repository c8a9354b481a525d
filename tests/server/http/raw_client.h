// A client that sends whatever bytes a test wants, and waits boundedly for what comes back.
#pragma once

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <chrono>
#include <stdexcept>
#include <string>

#include "server/http/socket.h"

namespace lastflat::http {

class RawClient {
public:
    explicit RawClient(int port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(static_cast<std::uint16_t>(port));
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        if (::connect(socket_.fd(), reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
            throw std::runtime_error("the test cannot connect");
        }
    }

    /// A client on a socket that is connected already.
    explicit RawClient(Socket socket) : socket_(std::move(socket)) {}

    /// False once the server has closed.
    bool send(const std::string& bytes) {
        std::size_t sent = 0;
        while (sent < bytes.size()) {
            const ssize_t step =
                ::send(socket_.fd(), bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
            if (step <= 0) return false;
            sent += static_cast<std::size_t>(step);
        }
        return true;
    }

    void finish_sending() { ::shutdown(socket_.fd(), SHUT_WR); }

    /// Everything up to the server's close; what there is when the time is over.
    std::string receive(std::chrono::milliseconds most = std::chrono::seconds(20)) {
        return receive_until("", most);
    }

    /// Ends early once `wanted` was received.
    std::string receive_until(const std::string& wanted,
                              std::chrono::milliseconds most = std::chrono::seconds(20)) {
        const auto deadline = Clock::now() + most;
        std::string received;
        std::array<char, 65536> step;
        while (wanted.empty() || received.find(wanted) == std::string::npos) {
            const auto left =
                std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
            pollfd watched{socket_.fd(), POLLIN, 0};
            if (left <= 0 || ::poll(&watched, 1, static_cast<int>(left)) <= 0) break;
            const ssize_t got = ::recv(socket_.fd(), step.data(), step.size(), 0);
            if (got <= 0) {
                closed_ = true;
                break;
            }
            received.append(step.data(), static_cast<std::size_t>(got));
        }
        return received;
    }

    /// What comes next, at most so many bytes; nothing: the server has closed.
    std::size_t receive_some(std::size_t bytes) {
        std::string step(bytes, '\0');
        const ssize_t got = ::recv(socket_.fd(), step.data(), step.size(), 0);
        return got > 0 ? static_cast<std::size_t>(got) : 0;
    }

    /// Whether the last `receive` ended because the server closed.
    [[nodiscard]] bool was_closed() const { return closed_; }

private:
    Socket socket_;
    bool closed_ = false;
};

/// Sends one request and returns the whole answer.
inline std::string ask(int port, const std::string& bytes) {
    RawClient client(port);
    client.send(bytes);
    return client.receive();
}

inline int status_of(const std::string& answer) {
    return answer.size() > 12 && answer.starts_with("HTTP/1.1 ") ? std::stoi(answer.substr(9, 3))
                                                                 : 0;
}

inline std::string body_of(const std::string& answer) {
    const std::size_t end = answer.find("\r\n\r\n");
    return end == std::string::npos ? "" : answer.substr(end + 4);
}

/// How many answers there are in what came back.
inline int count_of(const std::string& text, const std::string& wanted) {
    int count = 0;
    for (std::size_t at = text.find(wanted); at != std::string::npos;
         at = text.find(wanted, at + wanted.size())) {
        ++count;
    }
    return count;
}

}  // namespace lastflat::http
