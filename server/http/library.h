// What is left to cpp-httplib: it binds and accepts, reads the request line and writes answers.
// README.md says what is not, and why.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "server/http/buffer.h"
#include "server/http/connection_pool.h"
#include "server/http/http.h"
#include "server/http/socket.h"

namespace lastflat::http {

class HttpLibrary {
public:
    /// Called on the thread of `accept_until_stopped` with each connection.
    using Accept = std::function<void(Socket)>;
    /// Reads the whole body. Throws: api::Refusal.
    using ReadBody = std::function<Buffer()>;
    /// Makes the answer; `read_body` is empty if there is no body. Must not throw.
    using Answer = std::function<Response(const ReadBody& read_body)>;

    HttpLibrary(const ServerLimits& limits, Accept accept);
    ~HttpLibrary();
    HttpLibrary(const HttpLibrary&) = delete;
    HttpLibrary& operator=(const HttpLibrary&) = delete;

    /// Returns the port. Throws: std::runtime_error.
    int bind(const std::string& host, int port);
    /// False: accepting failed for good, although nobody called `stop`.
    [[nodiscard]] bool accept_until_stopped();
    /// Any thread, at any time, more than once.
    void stop();
    [[nodiscard]] bool is_stopped() const;

    struct Outcome {
        bool answered = false;  ///< false: the client is gone
        bool reusable = false;  ///< the connection is good for another request
        std::string rest;       ///< of which this is already read
        std::size_t bytes_received = 0, bytes_sent = 0;
        int status = 0;
    };
    /// Calls `answer`, writes what it returns.
    [[nodiscard]] Outcome exchange(VettedConnection& connection, const Answer& answer);

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace lastflat::http
