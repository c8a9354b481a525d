// HTTP as the rest of the server sees it: plain requests, plain responses, a table of routes.
// Nothing here, and nothing outside server/http/, knows which library speaks the protocol.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lastflat::http {

/// One part of a multipart/form-data body, or the one part of any other body (name empty). Its
/// bytes are those of the one body that all parts share, and last until the handler returns.
struct BodyPart {
    std::string name;        ///< UTF-8 without control characters
    std::string file_name;   ///< as the client gave it; never a path to open
    std::string media_type;  ///< "type/subtype" in lower case, without parameters; may be empty
    std::string_view bytes;
};

/// Where a handler may wait for something without taking a connection thread from others.
class WaitingRoom {
public:
    virtual ~WaitingRoom() = default;
    /// False: it is full; do not wait.
    [[nodiscard]] virtual bool enter() = 0;
    virtual void leave() = 0;
};

/// A seat in the waiting room, if there was one.
class Seat {
public:
    explicit Seat(WaitingRoom* room) : room_(room != nullptr && room->enter() ? room : nullptr) {}
    ~Seat() {
        if (room_ != nullptr) room_->leave();
    }
    Seat(const Seat&) = delete;
    Seat& operator=(const Seat&) = delete;
    [[nodiscard]] bool is_taken() const { return room_ != nullptr; }

private:
    WaitingRoom* const room_;
};

struct Request {
    std::string id;  ///< the client's X-Request-Id if it is fit for that, else one of ours
    std::string method;
    std::string path;                          ///< without the query
    std::map<std::string, std::string> query;  ///< percent-decoded; UTF-8, no control characters
    std::map<std::string, std::string>
        headers;                        ///< names in lower case; repeated ones joined by ", "
    std::vector<std::string> captures;  ///< what the route's groups matched
    std::string remote_address;         ///< of the client; only a trusted proxy can name another
    std::vector<BodyPart> body;         ///< empty for a request without one
    std::string principal;              ///< who asks, as `Admit` found out
    std::string restriction;            ///< what of the principal's alone it may use; empty: all
    bool is_limited = false;            ///< it may not do all that the principal may
    std::vector<std::pair<std::string, std::string>> answer_headers;  ///< whatever the answer is
    WaitingRoom* waiting_room = nullptr;
    std::function<bool()> is_client_gone;  ///< it has hung up; while the handler runs

    /// The header's value, empty if it is absent. `name` in lower case.
    [[nodiscard]] std::string_view header(const std::string& name) const {
        const auto found = headers.find(name);
        return found == headers.end() ? std::string_view() : std::string_view(found->second);
    }
};

/// Sends bytes of a stream; false once the client is gone.
using Write = std::function<bool(std::string_view bytes)>;

struct Response {
    int status = 200;
    std::string media_type;                   ///< of the body
    std::shared_ptr<const std::string> body;  ///< shared, so that a large result is not copied
    std::vector<std::pair<std::string, std::string>> headers;  ///< framing ones are ours: dropped
    /// Instead of a body: called again and again until it returns false, on the same thread.
    std::function<bool(const Write&)> stream;
};

using Handler = std::function<Response(const Request&)>;

/// `pattern` matches the whole path; "{id}" stands for a ULID (26 characters of 0-9 and A-Z) or a
/// UUID, "{digest}" for 64 hexadecimal digits: a path with anything else there is refused (400).
struct Route {
    std::string method;  ///< GET answers HEAD too
    std::string pattern;
    Handler handler;
    bool takes_body = false;  ///< without it a body is refused; only POST, PUT and PATCH can
    /// Answered even when all connections are taken. Must not block, and takes no body.
    bool express = false;
    std::vector<std::string> parameters{};  ///< names that its query may have; others are refused
};

struct ServerLimits {
    std::size_t body_bytes = 256u << 20;         ///< after chunking; multipart framing included
    std::size_t all_bodies_bytes = 1024u << 20;  ///< of all requests being served; more get 503
    std::size_t body_parts = 16;
    std::size_t head_bytes = 16u << 10;
    std::size_t head_lines = 100;
    std::size_t connections = 64;  ///< served at once, each on a thread; half of them of one client
    std::size_t waiting_requests = 64;  ///< in the waiting room
    /// Complete heads waiting for a thread; more get 503, half of them of one client: 429.
    std::size_t queued_requests = 256;
    std::size_t waiting_connections = 4096;  ///< head not complete; also bounded by RLIMIT_NOFILE
    /// From accept, or from the last answer, to the end of the head.
    std::chrono::milliseconds head_time{10'000};
    std::chrono::milliseconds body_time{60'000};   ///< from a thread taking the request to its end
    std::chrono::milliseconds write_time{60'000};  ///< for the whole answer
    /// Of a body that is sent and of an answer that is read, in every window of time.
    std::size_t least_bytes_per_second = 8192;
    std::chrono::milliseconds rate_window{10'000};
    std::chrono::milliseconds stop_time{5'000};  ///< for bodies and answers once `stop` is called
    std::vector<std::string> trusted_proxies{};  ///< whose X-Forwarded-For is believed: addresses
};

/// Makes the answer to what was thrown while a request was read (404, 405, 413, 503, ...) or by its
/// handler. `request` is empty if its head was no good. Called from several threads at once.
using ProblemMaker =
    std::function<Response(const Request& request, const std::exception_ptr& thrown)>;

/// Decides about a request before its body is read; what it throws ends the request. May set
/// `restriction`, `is_limited` and `principal`, which then is the client whose connections are
/// counted together (else those of an address are), and `answer_headers`. Called on connection
/// threads.
using Admit = std::function<void(Request&)>;

struct AnswerReport {
    const Request& request;    ///< without its body; empty if the head was no good
    std::string_view pattern;  ///< of the route; empty: none
    int status = 0;
    double seconds = 0.0;  ///< from the thread taking the request to the answer's last byte
    std::size_t bytes_received = 0, bytes_sent = 0;  ///< of bodies
};
/// Told of every answer. Called from several threads at once; must not throw.
using AnswerLog = std::function<void(const AnswerReport&)>;

/// The headers that let a web page of this origin read an answer; none: it may not.
using OriginHeaders =
    std::function<std::vector<std::pair<std::string, std::string>>(std::string_view origin)>;

struct ServerHooks {
    ProblemMaker problem;
    OriginHeaders origin_headers{};  ///< for requests that are refused before `admit` sees them
    Admit admit{};
    AnswerLog answered{};
};

/// An HTTP/1.1 server with keep-alive.
///
/// In:     the routes and limits; what makes problem documents; who is told of what.
/// Out:    every well-formed request is answered by its handler or by a problem; every handler runs
///         on a connection thread of its own; what a handler throws becomes one, too.
///         HEAD is answered by the GET handler, OPTIONS by the list of methods. `Range` is ignored.
/// Throws: std::invalid_argument if a route contradicts itself (see Route);
///         std::runtime_error from `bind` if the address cannot be bound, and from `run` if the
///         listening socket stays broken.
class Server {
public:
    Server(std::vector<Route> routes, ServerLimits limits, ServerHooks hooks);
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    /// Binds the address ("127.0.0.1", "0.0.0.0", "localhost", "::1", "[::1]"); port 0 picks one.
    /// Returns the port. Connections are queued by the kernel from here on.
    int bind(const std::string& host, int port);
    /// Serves until `stop` is called. Returns when every connection has ended. Once per server.
    void run();
    /// Stops accepting, drops unfinished heads, lets running and queued requests finish.
    /// Callable from any thread, before `run` and more than once.
    void stop();

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace lastflat::http
