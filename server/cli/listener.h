// An HTTP server on a thread of its own.
#pragma once

#include <exception>
#include <string>
#include <thread>

#include "server/cli/settings.h"
#include "server/http/http.h"

namespace lastflat::server {

class Listener {
public:
    /// Binds the address; connections wait until `start`. Throws: std::runtime_error.
    Listener(std::vector<http::Route> routes, const http::ServerLimits& limits,
             http::ServerHooks hooks, const Address& address);
    ~Listener() { stop(); }
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;

    void start();
    /// Returns when every answer is out.
    void stop();
    /// If the listener broke, by which it has sent the process SIGTERM, the reason.
    void rethrow() const;
    [[nodiscard]] const std::string& url() const { return url_; }

private:
    http::Server server_;
    const std::string url_;
    std::exception_ptr failure_;
    std::thread thread_;
};

}  // namespace lastflat::server
