// The only file that knows cpp-httplib.
#include "server/http/library.h"

#include <httplib.h>
#include <linux/sockios.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <thread>
#include <utility>

#include "server/http/answer.h"
#include "server/http/body_source.h"

namespace lastflat::http {
namespace {

constexpr int backlog = 511;
constexpr std::size_t write_step = 1u << 20;

/// What the library takes for the connection: it reads the canonical head and writes the answer.
class HeadStream : public httplib::Stream {
public:
    /// `write_time`: for the whole answer; 0: at once, or not at all.
    HeadStream(int fd, std::string head, const ServerLimits& limits,
               std::chrono::milliseconds write_time, const StopTime& stop_time)
        : fd_(fd),
          head_(std::move(head)),
          write_time_(write_time),
          stop_time_(stop_time),
          rate_(limits),
          write_deadline_(Clock::now() + write_time) {}

    void start_answer() {
        rate_.restart();
        write_deadline_ = Clock::now() + write_time_;
    }
    [[nodiscard]] bool write_failed() const { return write_failed_; }
    [[nodiscard]] std::size_t sent() const { return sent_; }

    bool is_readable() const override { return true; }
    bool is_writable() const override {
        return !write_failed_ && !has_hung_up(fd_) && Clock::now() < stop_time_.get();
    }
    ssize_t read(char* bytes, size_t size) override {
        const std::size_t given = head_.copy(bytes, size, head_used_);
        head_used_ += given;
        return static_cast<ssize_t>(given);
    }
    ssize_t write(const char* bytes, size_t size) override {
        std::size_t done = 0;
        sent_ += size;
        while (done < size && !write_failed_) {
            const ssize_t sent = ::send(fd_, bytes + done, size - done, MSG_NOSIGNAL);
            if (sent >= 0) {
                done += static_cast<std::size_t>(sent);
                written_ += static_cast<std::size_t>(sent);
                note_read();
            } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
                write_failed_ = !wait_until_writable();
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
    /// What the client's side has taken. The kernel says that a socket can be written only once a
    /// third of megabytes has gone, so a slow client would seem to read nothing for a long time.
    void note_read() {
        int waiting = 0;
        if (::ioctl(fd_, SIOCOUTQ, &waiting) != 0) return;
        const std::size_t taken = written_ - std::min(written_, static_cast<std::size_t>(waiting));
        rate_.note(taken - std::min(taken, taken_));
        taken_ = std::max(taken, taken_);
    }
    [[nodiscard]] bool wait_until_writable() {
        for (;;) {
            const auto deadline = std::min(write_deadline_, rate_.deadline());
            if (wait_for(fd_, SocketEvent::writable, deadline, stop_time_)) return true;
            note_read();
            const auto now = Clock::now();
            if (now >= std::min({write_deadline_, rate_.deadline(), stop_time_.get()}))
                return false;
        }
    }

    const int fd_;
    const std::string head_;
    std::size_t head_used_ = 0;
    const std::chrono::milliseconds write_time_;
    const StopTime& stop_time_;
    LeastRate rate_;
    Clock::time_point write_deadline_;
    std::size_t sent_ = 0;                 ///< of the answer
    std::size_t written_ = 0, taken_ = 0;  ///< to the socket; by the client's side
    bool write_failed_ = false;
};

/// Runs everything at once on the thread that accepts: all that is queued is a hand-over.
class InlineQueue : public httplib::TaskQueue {
public:
    void enqueue(std::function<void()> task) override { task(); }
    void shutdown() override {}
};

/// The library's server, opened where its own threads and sockets would take over. One listens;
/// every exchange has one of its own, so that its handlers know which exchange is theirs.
class OpenedServer : public httplib::Server {
public:
    using Accept = std::function<void(Socket)>;

    /// For one exchange. An invalid socket would mean to the library that it is shutting down.
    explicit OpenedServer(int served) { svr_sock_ = served; }

    explicit OpenedServer(Accept accept) : accept_(std::move(accept)) {
        new_task_queue = [] { return new InlineQueue; };
        set_idle_interval(0);
        // Not the default SO_REUSEPORT: a second server on the port must fail, not share it.
        set_socket_options([](socket_t fd) {
            const int on = 1;
            ::setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
            ::fcntl(fd, F_SETFD, FD_CLOEXEC);
        });
    }

    using httplib::Server::process_request;
    using httplib::Server::svr_sock_;

private:
    bool process_and_close_socket(socket_t fd) override {
        accept_(Socket(fd));
        return true;
    }

    const Accept accept_;
};

/// Its answer is small and no client may make its thread wait: it counts for nobody.
bool must_hurry(const VettedConnection& connection) {
    return connection.refused.has_value() || connection.head.route->express;
}

/// One request on its thread, from the vetted head to the last byte of the answer.
class Exchange {
public:
    Exchange(VettedConnection& connection, const HttpLibrary::Answer& answer,
             const ServerLimits& limits, BodyBytes& all_bodies, const StopTime& stop_time)
        : head_(connection.head),
          answer_(answer),
          body_(connection.socket.fd(), head_, std::move(connection.early_body), limits, all_bodies,
                stop_time),
          stream_(connection.socket.fd(), canonical_head(head_), limits,
                  must_hurry(connection) ? std::chrono::milliseconds(0) : limits.write_time,
                  stop_time) {}

    /// `stays`: whether the connection may serve another request.
    [[nodiscard]] HttpLibrary::Outcome run(bool stays);

private:
    void respond(httplib::Response& out);
    void complete_headers(httplib::Response& out);
    void give(const Response& answer, httplib::Response& out);
    void give_stream(const Response& answer, httplib::Response& out);

    const Head& head_;
    const HttpLibrary::Answer& answer_;
    BodySource body_;
    HeadStream stream_;
    bool stays_ = false;
    int status_ = 0;
    bool ranges_ = false;  ///< the answer says itself what ranges it has
};

HttpLibrary::Outcome Exchange::run(bool stays) {
    stays_ = stays;
    OpenedServer server(stream_.socket());
    server.set_pre_routing_handler([this](const httplib::Request&, httplib::Response& out) {
        respond(out);
        return httplib::Server::HandlerResponse::Handled;
    });
    server.set_post_routing_handler(
        [this](const httplib::Request&, httplib::Response& out) { complete_headers(out); });
    bool closed = false;
    const bool done = server.process_request(stream_, false, closed, nullptr);
    HttpLibrary::Outcome outcome;
    outcome.answered = !stream_.write_failed();
    outcome.reusable = done && outcome.answered && stays_;
    if (outcome.reusable) outcome.rest = body_.rest();
    outcome.bytes_received = body_.raw_bytes();
    outcome.bytes_sent = stream_.sent();
    outcome.status = status_;
    return outcome;
}

void Exchange::respond(httplib::Response& out) {
    const auto read_body = [this] { return body_.read(); };
    const Response answer =
        answer_(head_.has_body() ? HttpLibrary::ReadBody(read_body) : HttpLibrary::ReadBody());
    stream_.start_answer();
    give(answer, out);
    status_ = out.status;
}

/// Once the answer is known. What the library adds of its own is wrong here: a 204 has no length,
/// and a body that was not read to its end would be taken for a request.
void Exchange::complete_headers(httplib::Response& out) {
    if (out.status == 204 || out.status == 304) out.headers.erase("Content-Length");
    stays_ = stays_ && body_.is_complete();
    if (!ranges_) out.headers.erase("Accept-Ranges");
    out.headers.erase("Connection");
    out.headers.erase("Keep-Alive");
    if (!stays_) out.set_header("Connection", "close");
}

/// Moves an answer into the library's. A body goes through a provider: set_content would copy it,
/// and might compress it for minutes.
void Exchange::give(const Response& answer, httplib::Response& out) {
    const bool has_status = answer.status >= 200 && answer.status <= 599;
    out.status = has_status ? answer.status : 500;
    for (const auto& [name, value] : outgoing_headers(answer)) {
        if (name == "Accept-Ranges") ranges_ = true;
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

/// One call of the provider for each of the stream.
void Exchange::give_stream(const Response& answer, httplib::Response& out) {
    out.set_chunked_content_provider(
        outgoing_media_type(answer),
        [this, stream = answer.stream](size_t, httplib::DataSink& sink) noexcept {
            try {
                const auto write = [&](std::string_view bytes) {
                    stream_.start_answer();
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
        : limits_(limits),
          all_bodies_(limits.all_bodies_bytes),
          server_([this, accept = std::move(accept)](Socket socket) {
              ++accepted_;
              prepare_accepted(socket.fd());
              accept(std::move(socket));
          }) {}

    int bind(const std::string& host, int port);
    bool accept_until_stopped();
    void stop();
    Outcome exchange(VettedConnection& connection, const Answer& answer);

    [[nodiscard]] bool is_stopped() const { return stopped_; }

private:
    const ServerLimits limits_;
    BodyBytes all_bodies_;
    OpenedServer server_;
    StopTime stop_time_;
    std::atomic<bool> stopped_{false};
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
    if (port <= 0 || ::listen(server_.svr_sock_, backlog) != 0) {
        const std::string cause = errno != 0 ? std::strerror(errno) : "not an address of this host";
        throw std::runtime_error("cannot listen on " + host + ": " + cause);
    }
    listener_owner_ = Socket(::fcntl(server_.svr_sock_, F_DUPFD_CLOEXEC, 0));
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
            ::close(server_.svr_sock_);
        }
        if (stopped_) break;
        failures = accepted_ == accepted_before ? failures + 1 : 0;
        if (failures > most_failures) return false;
        std::this_thread::sleep_for(pause);
        server_.svr_sock_ = ::fcntl(listener_, F_DUPFD_CLOEXEC, 0);
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
    Exchange exchange(connection, answer, limits_, all_bodies_, stop_time_);
    return exchange.run(connection.head.keeps_alive && !stopped_);
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
