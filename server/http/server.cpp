// Puts the layer together: the library accepts, the gate waits for heads, the pools serve.
#include <algorithm>
#include <atomic>
#include <exception>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "server/http/answer.h"
#include "server/http/client_address.h"
#include "server/http/connection_gate.h"
#include "server/http/connection_pool.h"
#include "server/http/head.h"
#include "server/http/http.h"
#include "server/http/library.h"
#include "server/http/multipart.h"
#include "server/http/refusal.h"
#include "server/http/route_table.h"
#include "server/http/text.h"

namespace lastflat::http {
namespace {

constexpr std::size_t express_threads = 2;
constexpr std::size_t most_queued_express = 64;

std::vector<BodyPart> parts_of(const Head& head, std::string_view body, std::size_t most_parts) {
    const std::string_view content_type = head.request.header("content-type");
    const std::string media_type = media_type_of(content_type);
    if (media_type == "multipart/form-data") {
        return parse_multipart(content_type, body, most_parts);
    }
    std::vector<BodyPart> parts(1);
    parts[0].media_type = media_type;
    parts[0].bytes = body;
    return parts;
}

/// A misspelt parameter would be ignored in silence. OPTIONS has that of the request that a browser
/// asks about.
void check_query(const Head& head) {
    if (head.request.method == "OPTIONS") return;
    const std::vector<std::string>& known = head.route->parameters;
    for (const auto& [name, value] : head.request.query) {
        if (std::find(known.begin(), known.end(), name) != known.end()) continue;
        std::string list;
        for (const std::string& word : known) list += (list.empty() ? "" : ", ") + word;
        throw api::Refusal("parameter_unknown",
                           "unknown parameter '" + name.substr(0, 40) + "'; " +
                               (list.empty() ? "this path has none" : "known are " + list));
    }
}

}  // namespace

class Server::Impl {
public:
    Impl(std::vector<Route> routes, ServerLimits limits, ServerHooks hooks)
        : routes_(std::move(routes)),
          limits_(limits),
          hooks_(std::move(hooks)),
          library_(limits, [this](Socket socket) { gate_->admit(std::move(socket)); }) {}

    int bind(const std::string& host, int port) { return library_.bind(host, port); }
    void run();
    void stop() { library_.stop(); }

private:
    [[nodiscard]] std::optional<std::string> on_head(Socket& socket, std::string& bytes,
                                                     std::size_t head_size);
    [[nodiscard]] std::string refusal_bytes(const RefusedHead& refusal) const;
    [[nodiscard]] std::string request_id(const Request& request);
    [[nodiscard]] std::unique_ptr<ConnectionPool> pool(const PoolLimits& limits);
    [[nodiscard]] std::string identify(VettedConnection& connection);
    void serve(VettedConnection connection, WaitingRoom& room);
    [[nodiscard]] Response handle(Head& head, const HttpLibrary::ReadBody& read_body,
                                  Buffer& body) const;

    const RouteTable routes_;
    const ServerLimits limits_;
    const ServerHooks hooks_;
    std::atomic<std::uint64_t> requests_{0};
    /// Tells the requests of one start from those of another.
    const std::string start_ = std::to_string(std::chrono::system_clock::now().time_since_epoch() /
                                              std::chrono::microseconds(1));
    HttpLibrary library_;
    std::unique_ptr<ConnectionGate> gate_;
    std::unique_ptr<ConnectionPool> pool_;
    std::unique_ptr<ConnectionPool> express_pool_;
};

void Server::Impl::run() {
    if (library_.is_stopped()) return;
    gate_ = std::make_unique<ConnectionGate>(
        limits_,
        [this](Socket& socket, std::string& bytes, std::size_t head_size) {
            return on_head(socket, bytes, head_size);
        },
        [this](const RefusedHead& refusal) { return refusal_bytes(refusal); });
    pool_ = pool({limits_.connections, (limits_.connections + 1) / 2, limits_.waiting_requests,
                  limits_.queued_requests, std::max<std::size_t>(1, limits_.queued_requests / 2)});
    express_pool_ =
        pool({express_threads, express_threads, 0, most_queued_express, most_queued_express});

    const bool was_stopped = library_.accept_until_stopped();

    // The gate last: the pools hand it the connections they have answered.
    gate_->drop_unfinished();
    pool_->finish();
    express_pool_->finish();
    gate_->finish();
    if (!was_stopped) throw std::runtime_error("the listening socket does not accept any more");
}

std::optional<std::string> Server::Impl::on_head(Socket& socket, std::string& bytes,
                                                 std::size_t head_size) {
    try {
        VettedConnection connection;
        connection.head = vet_head(std::string_view(bytes).substr(0, head_size), routes_, limits_);
        connection.early_body = bytes.substr(head_size);
        const bool without_body = connection.head.request.method == "HEAD";
        ConnectionPool& pool = connection.head.route->express ? *express_pool_ : *pool_;
        connection.socket = std::move(socket);
        if (pool.offer(connection)) return std::nullopt;
        socket = std::move(connection.socket);
        return refusal_bytes(
            {overloaded(), connection.head.request.header("origin"), without_body});
    } catch (const RefusedHead& refusal) {
        return refusal_bytes(refusal);
    }
}

std::string Server::Impl::refusal_bytes(const RefusedHead& refusal) const {
    const Request unknown;
    Response response = answer_to(unknown, std::make_exception_ptr(refusal), hooks_.problem);
    if (hooks_.answered) hooks_.answered({unknown, "", response.status});
    if (hooks_.origin_headers) {
        for (auto& header : hooks_.origin_headers(refusal.origin()))
            response.headers.push_back(std::move(header));
    }
    return answer_bytes(response, refusal.is_without_body());
}

/// The client's own, if a log can hold it; else ours, which no two requests share.
std::string Server::Impl::request_id(const Request& request) {
    constexpr std::size_t longest = 128;
    const std::string_view given = request.header("x-request-id");
    if (is_token(given) && given.size() <= longest) return std::string(given);
    return start_ + "-" + std::to_string(++requests_);
}

std::unique_ptr<ConnectionPool> Server::Impl::pool(const PoolLimits& limits) {
    return std::make_unique<ConnectionPool>(
        limits, [this](VettedConnection& connection) { return identify(connection); },
        [this](VettedConnection connection, WaitingRoom& room) {
            serve(std::move(connection), room);
        },
        [this](const Request& request) {
            return answer_to(request, std::make_exception_ptr(client_busy()), hooks_.problem);
        });
}

std::string Server::Impl::identify(VettedConnection& connection) {
    connection.begun = Clock::now();
    Request& request = connection.head.request;
    request.remote_address =
        client_address(peer_address(connection.socket.fd()), request.header("x-forwarded-for"),
                       limits_.trusted_proxies);
    request.id = request_id(request);
    request.answer_headers.emplace_back("X-Request-Id", request.id);
    try {
        if (hooks_.admit) hooks_.admit(request);
    } catch (...) {
        connection.refused = answer_to(request, std::current_exception(), hooks_.problem);
    }
    if (!request.principal.empty()) return "key " + request.principal;
    return "address " + network_of(request.remote_address);
}

void Server::Impl::serve(VettedConnection connection, WaitingRoom& room) {
    Head& head = connection.head;
    Request& request = head.request;
    request.waiting_room = &room;
    request.is_client_gone = [fd = connection.socket.fd()] { return has_hung_up(fd); };
    auto& refused = connection.refused;
    // The library would ask the client for a body that nobody wants.
    if (refused) head.awaits_continue = false;
    auto outcome = library_.exchange(connection, [&](const HttpLibrary::ReadBody& read_body) {
        Buffer body;
        Response response = refused ? std::move(*refused) : handle(head, read_body, body);
        request.body.clear();  // its parts are of `body`
        response.headers.insert(response.headers.end(), request.answer_headers.begin(),
                                request.answer_headers.end());
        return response;
    });
    if (hooks_.answered) {
        const std::chrono::duration<double> taken = Clock::now() - connection.begun;
        hooks_.answered({request, head.route->pattern, outcome.status, taken.count(),
                         outcome.bytes_received, outcome.bytes_sent});
    }
    if (outcome.reusable)
        gate_->admit(std::move(connection.socket), std::move(outcome.rest));
    else if (outcome.answered)
        gate_->linger(std::move(connection.socket));
}

Response Server::Impl::handle(Head& head, const HttpLibrary::ReadBody& read_body,
                              Buffer& body) const {
    try {
        check_query(head);
        if (read_body) {
            body = read_body();
            head.request.body = parts_of(head, body.view(), limits_.body_parts);
        }
        Response response = head.route->handler(head.request);
        if (response.stream && !head.takes_chunks)
            throw api::Refusal("version_not_supported", "A stream needs HTTP/1.1.");
        return response;
    } catch (...) {
        return answer_to(head.request, std::current_exception(), hooks_.problem);
    }
}

Server::Server(std::vector<Route> routes, ServerLimits limits, ServerHooks hooks)
    : impl_(std::make_unique<Impl>(std::move(routes), limits, std::move(hooks))) {}

Server::~Server() = default;

int Server::bind(const std::string& host, int port) {
    return impl_->bind(host, port);
}

void Server::run() {
    impl_->run();
}

void Server::stop() {
    impl_->stop();
}

}  // namespace lastflat::http
