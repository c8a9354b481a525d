#include "server/cli/listener.h"

#include <signal.h>
#include <unistd.h>

namespace lastflat::server {
namespace {

std::string url_of(const std::string& host, int port) {
    const bool bare_ipv6 = host.find(':') != std::string::npos && host.front() != '[';
    return "http://" + (bare_ipv6 ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

}  // namespace

Listener::Listener(std::vector<http::Route> routes, const http::ServerLimits& limits,
                   http::ServerHooks hooks, const Address& address)
    : server_(std::move(routes), limits, std::move(hooks)),
      url_(url_of(address.host, server_.bind(address.host, address.port))) {}

void Listener::start() {
    thread_ = std::thread([this] {
        try {
            server_.run();
        } catch (...) {
            failure_ = std::current_exception();
            kill(getpid(), SIGTERM);  // the service cannot go on without it
        }
    });
}

void Listener::stop() {
    server_.stop();
    if (thread_.joinable()) thread_.join();
}

void Listener::rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
}

}  // namespace lastflat::server
