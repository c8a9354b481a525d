// The only file that knows cpp-httplib.
#include "server/http/library.h"

#include <httplib.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <thread>

#include "server/http/answer.h"
#include "server/http/body_source.h"

namespace lastflat::http {
namespace {

constexpr int backlog = 511;
constexpr std::size_t write_step = 1u << 20;

/// The head that the library reads: one path, no header of the client's own making.
std::string plain_head(const Head& head) {
    if (!head.has_body()) {
        return head.request.method == "HEAD" ? "HEAD / HTTP/1.1\r\n\r\n" : "GET / HTTP/1.1\r\n\r\n";
    }
    std::string text = "POST / HTTP/1.1\r\n";
    text += head.chunked ? "Transfer-Encoding: chunked\r\n"
                         : "Content-Length: " + std::to_string(head.content_length) + "\r\n";
    if (head.awaits_continue) text += "Expect: 100-continue\r\n";
    return text + "\r\n";
}

/// What the library takes for the connection: our head, then the body, then nothing.
class RequestStream : public httplib::Stream {
public:
    RequestStream(VettedConnection& connection, const ServerLimits& limits,
                  const StopTime& stop_time)
        : fd_(connection.socket.fd()),
          head_(plain_head(connection.head)),
          body_(fd_, connection.head, std::move(connection.early_body), limits, stop_time),
          limits_(limits),
          stop_time_(stop_time),
          write_deadline_(Clock::now() + limits.write_time) {}

    [[nodiscard]] const BodySource& body() const { return body_; }
    void start_answer() { write_deadline_ = Clock::now() + limits_.write_time; }
    [[nodiscard]] bool write_failed() const { return write_failed_; }
    [[nodiscard]] std::size_t sent() const { return sent_; }

    bool is_readable() const override { return true; }
    /// A client that has closed its side is gone: what it sent is then an end, not bytes.
    bool is_writable() const override {
        char byte = 0;
        const bool closed = ::recv(fd_, &byte, 1, MSG_PEEK | MSG_DONTWAIT) == 0;
        return !write_failed_ && !closed && Clock::now() < stop_time_.get();
    }
    ssize_t read(char* bytes, size_t size) override {
        const std::size_t from_head = head_.copy(bytes, size, head_used_);
        head_used_ += from_head;
        return static_cast<ssize_t>(from_head > 0 ? from_head : body_.read(bytes, size));
    }
    ssize_t write(const char* bytes, size_t size) override {
        std::size_t done = 0;
        sent_ += size;
        while (done < size && !write_failed_) {
            const ssize_t sent = ::send(fd_, bytes + done, size - done, MSG_NOSIGNAL);
            if (sent >= 0) {
                done += static_cast<std::size_t>(sent);
            } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
                write_failed_ = !wait_for(fd_, SocketEvent::writable, write_deadline_, stop_time_);
            } else if (errno != EINTR) {
                write_failed_ = true;
            }
        }
        return write_failed_ ? -1 : static_cast<ssize_t>(size);
    }
    void get_remote_ip_and_port(std::string&, int&) const override {}
    void get_local_ip_and_port(std::string&, int&) const override {}
    socket_t socket() const override { return fd_; }

private:
    const int fd_;
    const std::string head_;
    std::size_t head_used_ = 0;
    BodySource body_;
    const ServerLimits& limits_;
    const StopTime& stop_time_;
    Clock::time_point write_deadline_;
    std::size_t sent_ = 0;
    bool write_failed_ = false;
};

/// Runs everything at once on the thread that accepts: all that is queued is a hand-over.
class InlineQueue : public httplib::TaskQueue {
public:
    void enqueue(std::function<void()> task) override { task(); }
    void shutdown() override {}
};

void complete_headers(httplib::Response& response);

/// The library's server, opened where its own threads and sockets would take over.
class OpenedServer : public httplib::Server {
public:
    using Accept = std::function<void(Socket)>;

    explicit OpenedServer(Accept accept) : accept_(std::move(accept)) {
        new_task_queue = [] { return new InlineQueue; };
        set_idle_interval(0);
        // Not the default SO_REUSEPORT: a second server on the port must fail, not share it.
        set_socket_options([](socket_t fd) {
            const int on = 1;
            ::setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
            ::fcntl(fd, F_SETFD, FD_CLOEXEC);
        });
        // Added by the library, wrong here: these have no body.
        set_post_routing_handler([](const httplib::Request&, httplib::Response& response) {
            if (response.status == 204 || response.status == 304) {
                response.headers.erase("Content-Length");
            }
            complete_headers(response);
        });
    }

    using httplib::Server::process_request;

    [[nodiscard]] int listener() const { return svr_sock_; }
    void listen_on(int fd) { svr_sock_ = fd; }

private:
    bool process_and_close_socket(socket_t fd) override {
        accept_(Socket(fd));
        return true;
    }

    const Accept accept_;
};

/// Counts the body bytes of all requests; gives back its own at the end.
class BodyShare {
public:
    BodyShare(std::atomic<std::size_t>& total, std::size_t most) : total_(total), most_(most) {}
    ~BodyShare() { total_ -= own_; }
    BodyShare(const BodyShare&) = delete;
    BodyShare& operator=(const BodyShare&) = delete;

    [[nodiscard]] bool grow(std::size_t bytes) {
        own_ += bytes;
        return (total_ += bytes) <= most_;
    }

private:
    std::atomic<std::size_t>& total_;
    const std::size_t most_;
    std::size_t own_ = 0;
};

/// One request on its thread. The library calls handlers without a context, so this is found by
/// the thread.
struct Exchange {
    const HttpLibrary::Answer& answer;
    RequestStream& stream;
    BodyShare& share;
    bool stays;  ///< the connection, for another request
    int status = 0;
    bool ranges = false;  ///< the answer says itself what ranges it has
};
thread_local Exchange* current_exchange = nullptr;

/// Once the answer is known: a body that was not read to its end would be taken for a request.
void complete_headers(httplib::Response& response) {
    Exchange& exchange = *current_exchange;
    exchange.stays = exchange.stays && exchange.stream.body().is_complete();
    if (!exchange.ranges) response.headers.erase("Accept-Ranges");
    response.headers.erase("Connection");
    response.headers.erase("Keep-Alive");
    if (!exchange.stays) response.set_header("Connection", "close");
}

std::string read_body(Exchange& exchange, const ServerLimits& limits,
                      const httplib::ContentReader& reader) {
    std::string body;
    bool too_large = false;
    bool no_room = false;
    const bool read = reader([&](const char* bytes, size_t size) {
        // The announced length was vetted and chunks were counted; this is the last word.
        too_large = body.size() + size > limits.body_bytes;
        no_room = !exchange.share.grow(size);
        if (too_large || no_room) return false;
        body.append(bytes, size);
        return true;
    });
    if (no_room) throw overloaded();
    if (too_large) throw Refusal(413, "body_too_large", "The body is too large.");
    exchange.stream.body().check_complete();
    if (!read) throw Refusal(400, "body_cut_off", "The body could not be read.");
    return body;
}

/// One call of the provider for each of the stream.
void give_stream(const Response& answer, httplib::Response& out) {
    out.set_chunked_content_provider(
        outgoing_media_type(answer),
        [stream = answer.stream](size_t, httplib::DataSink& sink) noexcept {
            try {
                const auto write = [&](std::string_view bytes) {
                    current_exchange->stream.start_answer();
                    return sink.is_writable() && sink.write(bytes.data(), bytes.size());
                };
                if (stream(write)) return sink.is_writable();
                sink.done();
                return true;
            } catch (...) {
                return false;  // the stream breaks off, which its client sees
            }
        });
}

/// Moves an answer into the library's. A body goes through a provider: set_content would copy it,
/// and might compress it for minutes.
void give(const Response& answer, httplib::Response& out) {
    const bool has_status = answer.status >= 200 && answer.status <= 599;
    out.status = has_status ? answer.status : 500;
    for (const auto& [name, value] : outgoing_headers(answer)) {
        if (name == "Accept-Ranges") current_exchange->ranges = true;
        out.set_header(name, value);
    }
    const bool bodiless = out.status == 204 || out.status == 304;
    if (answer.stream && !bodiless) return give_stream(answer, out);
    if (!answer.body || answer.body->empty() || bodiless) return;
    out.set_content_provider(
        answer.body->size(), outgoing_media_type(answer),
        [body = answer.body](size_t offset, size_t length, httplib::DataSink& sink) noexcept {
            if (offset >= body->size()) return false;
            const std::size_t size = std::min({length, body->size() - offset, write_step});
            return sink.write(body->data() + offset, size);
        });
}

void answer_through(const HttpLibrary::ReadBody& body, httplib::Response& out) {
    const Response response = current_exchange->answer(body);
    current_exchange->stream.start_answer();
    give(response, out);
    current_exchange->status = out.status;
}

/// Bound by name would mean either family; the loopback that every client tries is this one.
std::string numeric_host(const std::string& host) {
    if (host == "localhost") return "127.0.0.1";
    const bool bracketed = host.size() > 2 && host.front() == '[' && host.back() == ']';
    return bracketed ? host.substr(1, host.size() - 2) : host;
}

}  // namespace

class HttpLibrary::Impl {
public:
    using Outcome = HttpLibrary::Outcome;

    Impl(const ServerLimits& limits, Accept accept)
        : limits_(limits), server_([this, accept = std::move(accept)](Socket socket) {
              ++accepted_;
              prepare_accepted(socket.fd());
              accept(std::move(socket));
          }) {
        server_.Get("/", [](const httplib::Request&, httplib::Response& out) {
            answer_through(nullptr, out);
        });
        server_.Post("/", [this](const httplib::Request&, httplib::Response& out,
                                 const httplib::ContentReader& reader) {
            answer_through([&] { return read_body(*current_exchange, limits_, reader); }, out);
        });
    }

    int bind(const std::string& host, int port);
    bool accept_until_stopped();
    void stop();
    Outcome exchange(VettedConnection& connection, const Answer& answer);

    [[nodiscard]] bool is_stopped() const { return stopped_; }

private:
    const ServerLimits limits_;
    OpenedServer server_;
    StopTime stop_time_;
    std::atomic<bool> stopped_{false};
    std::atomic<std::size_t> body_bytes_{0};
    std::atomic<std::uint64_t> accepted_{0};
    /// Our own hold on the listening socket: the library closes its descriptor after some errors
    /// of accept, and this one keeps the port and the kernel's queue until we listen again.
    Socket listener_owner_;
    std::atomic<int> listener_{-1};  ///< listener_owner_'s, for `stop` on any thread
};

int HttpLibrary::Impl::bind(const std::string& host, int port) {
    if (listener_owner_.is_open()) throw std::runtime_error("the server is already bound");
    const std::string numeric = numeric_host(host);
    errno = 0;
    if (port == 0) {
        port = server_.bind_to_any_port(numeric);
    } else if (!server_.bind_to_port(numeric, port)) {
        port = -1;
    }
    // The library listens with a backlog of 5; listening again only changes that number.
    if (port <= 0 || ::listen(server_.listener(), backlog) != 0) {
        const std::string cause = errno != 0 ? std::strerror(errno) : "not an address of this host";
        throw std::runtime_error("cannot listen on " + host + ": " + cause);
    }
    listener_owner_ = Socket(::fcntl(server_.listener(), F_DUPFD_CLOEXEC, 0));
    if (!listener_owner_.is_open()) throw std::runtime_error("cannot listen: no descriptors left");
    listener_ = listener_owner_.fd();
    if (stopped_) stop();
    return port;
}

bool HttpLibrary::Impl::accept_until_stopped() {
    if (!listener_owner_.is_open()) throw std::logic_error("run before bind");
    constexpr int most_failures = 100;
    constexpr std::chrono::milliseconds pause{10};
    int failures = 0;
    while (!stopped_) {
        const std::uint64_t accepted_before = accepted_;
        try {
            server_.listen_after_bind();
        } catch (const std::exception&) {
            // Out of memory; the pause below may mend it. The library left its descriptor open.
            ::close(server_.listener());
        }
        if (stopped_) break;
        failures = accepted_ == accepted_before ? failures + 1 : 0;
        const int fd = ::fcntl(listener_, F_DUPFD_CLOEXEC, 0);
        if (failures > most_failures) {
            if (fd >= 0) ::close(fd);
            return false;
        }
        std::this_thread::sleep_for(pause);
        server_.listen_on(fd);
    }
    return true;
}

void HttpLibrary::Impl::stop() {
    if (!stopped_.exchange(true)) stop_time_.set(Clock::now() + limits_.stop_time);
    // Wakes the thread in accept, and every accept after this one fails.
    if (listener_ >= 0) ::shutdown(listener_, SHUT_RDWR);
}

HttpLibrary::Outcome HttpLibrary::Impl::exchange(VettedConnection& connection,
                                                 const Answer& answer) {
    RequestStream stream(connection, limits_, stop_time_);
    BodyShare share(body_bytes_, limits_.all_bodies_bytes);
    Exchange exchange{answer, stream, share, connection.head.keeps_alive && !stopped_};
    current_exchange = &exchange;
    bool closed = false;
    const bool done = server_.process_request(stream, false, closed, nullptr);
    current_exchange = nullptr;
    Outcome outcome;
    outcome.answered = !stream.write_failed();
    outcome.reusable = done && outcome.answered && exchange.stays;
    if (outcome.reusable) outcome.rest = stream.body().rest();
    outcome.bytes_received = stream.body().raw_bytes();
    outcome.bytes_sent = stream.sent();
    outcome.status = exchange.status;
    return outcome;
}

HttpLibrary::HttpLibrary(const ServerLimits& limits, Accept accept)
    : impl_(std::make_unique<Impl>(limits, std::move(accept))) {}

HttpLibrary::~HttpLibrary() = default;

int HttpLibrary::bind(const std::string& host, int port) {
    return impl_->bind(host, port);
}

bool HttpLibrary::accept_until_stopped() {
    return impl_->accept_until_stopped();
}

void HttpLibrary::stop() {
    impl_->stop();
}

bool HttpLibrary::is_stopped() const {
    return impl_->is_stopped();
}

HttpLibrary::Outcome HttpLibrary::exchange(VettedConnection& connection, const Answer& answer) {
    return impl_->exchange(connection, answer);
}

}  // namespace lastflat::http
