// A server on its own thread and port, with routes that the tests of this folder share.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>

#include "api/problem_of.h"
#include "server/http/http.h"
#include "tests/server/http/raw_client.h"

namespace lastflat::http {

inline Response text_response(std::string text) {
    Response response;
    response.media_type = "text/plain";
    response.body = std::make_shared<const std::string>(std::move(text));
    return response;
}

inline Response test_problem(const Request&, const std::exception_ptr& thrown) {
    const api::Refusal refusal = api::refusal_of(thrown);
    Response response = text_response(std::string(refusal.problem().code.word()));
    response.status = refusal.problem().status;
    response.headers = refusal.headers();
    response.media_type = "application/problem+json";
    return response;
}

/// What handlers wait behind until the test lets them go on.
class Turnstile {
public:
    ~Turnstile() { open(); }
    void pass() {
        std::unique_lock lock(mutex_);
        ++waiting_;
        changed_.notify_all();
        changed_.wait(lock, [this] { return open_; });
    }
    /// Passes without waiting.
    void count() {
        const std::lock_guard lock(mutex_);
        ++waiting_;
        changed_.notify_all();
    }
    void open() {
        const std::lock_guard lock(mutex_);
        open_ = true;
        changed_.notify_all();
    }
    /// Whether `count` handlers came within a bounded time.
    [[nodiscard]] bool wait_for(int count) {
        std::unique_lock lock(mutex_);
        return changed_.wait_for(lock, std::chrono::seconds(20), [&] { return waiting_ >= count; });
    }
    [[nodiscard]] int waiting() {
        const std::lock_guard lock(mutex_);
        return waiting_;
    }

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    int waiting_ = 0;
    bool open_ = false;
};

class RunningServer {
public:
    explicit RunningServer(const ServerLimits& limits = {})
        : server_(routes(), limits, hooks()), port_(server_.bind("127.0.0.1", 0)), thread_([this] {
              try {
                  server_.run();
              } catch (const std::exception& error) {
                  const std::lock_guard lock(mutex_);
                  run_error_ = error.what();
              }
          }) {}
    ~RunningServer() { stop(); }
    RunningServer(const RunningServer&) = delete;
    RunningServer& operator=(const RunningServer&) = delete;

    [[nodiscard]] int port() const { return port_; }
    [[nodiscard]] Server& server() { return server_; }
    Turnstile turnstile;

    void stop() {
        turnstile.open();
        server_.stop();
        join();
    }
    void join() {
        if (thread_.joinable()) thread_.join();
    }
    [[nodiscard]] std::string failures() {
        const std::lock_guard lock(mutex_);
        return failures_;
    }
    [[nodiscard]] std::string run_error() {
        const std::lock_guard lock(mutex_);
        return run_error_;
    }

    static constexpr std::size_t large_size = 3'000'000;

private:
    ServerHooks hooks() {
        ServerHooks hooks;
        hooks.problem = [this](const Request& request, const std::exception_ptr& thrown) {
            Response response = test_problem(request, thrown);
            const std::lock_guard lock(mutex_);
            if (response.status == 500)
                failures_ += api::refusal_of(thrown).what() + std::string(";");
            return response;
        };
        hooks.admit = [](Request& request) {
            request.answer_headers.emplace_back("X-Admitted", "yes");
            if (request.header("authorization") == "no") api::refuse("key_missing", "no key");
            request.principal = request.header("x-who");
        };
        hooks.origin_headers = [](std::string_view origin) {
            return std::vector<std::pair<std::string, std::string>>{
                {"X-Origin", std::string(origin)}};
        };
        return hooks;
    }

    /// Says what reached the handler, so that a test can see it.
    static Response echo(const Request& request) {
        std::string text = request.method + " " + request.path + " " + request.remote_address;
        for (const BodyPart& part : request.body) {
            text += "\n" + part.name + "|" + part.media_type + "|";
            text += part.bytes;
        }
        return text_response(text);
    }

    static Response with_bad_headers(const Request&) {
        Response response = text_response("x");
        response.headers = {{"X-Good", "yes"},      {"X-Split", "a\r\nX-Injected: b"},
                            {"Bad name", "x"},      {"Content-Length", "99"},
                            {"Connection", "keep"}, {"Transfer-Encoding", "chunked"}};
        return response;
    }

    std::vector<Route> routes() {
        std::vector<Route> all = plain_routes();
        for (const char* method : {"GET", "POST", "PUT", "PATCH", "DELETE", "OPTIONS"}) {
            const bool takes_body = std::string_view(method).front() == 'P';
            all.push_back({method, "/v1/..//{id}:any.", echo, takes_body, false, {"a"}});
        }
        return all;
    }

    std::vector<Route> plain_routes() {
        return {
            {"GET", "/healthz", [](const Request&) { return text_response("ok"); }, false, true},
            {"GET", "/echo", echo, false, false, {"a"}},
            {"POST", "/echo", echo, true},
            {"GET", "/v1/jobs/{id}", echo},
            {"GET", "/headers", with_bad_headers},
            {"GET", "/empty",
             [](const Request&) {
                 Response response;
                 response.status = 204;
                 return response;
             }},
            {"GET", "/large",
             [](const Request&) { return text_response(std::string(large_size, 'x')); }},
            // Far more than the kernel buffers for a client that does not read.
            {"GET", "/huge",
             [](const Request&) { return text_response(std::string(40 * large_size, 'x')); }},
            {"GET", "/throw",
             [](const Request&) -> Response { throw std::runtime_error("the secret"); }},
            {"GET", "/throw-int", [](const Request&) -> Response { throw 7; }},
            {"GET", "/wait",
             [this](const Request&) {
                 turnstile.pass();
                 return text_response("waited");
             }},
            {"GET", "/until-gone",
             [this](const Request& request) {
                 turnstile.count();
                 while (!request.is_client_gone())
                     std::this_thread::sleep_for(std::chrono::milliseconds(5));
                 turnstile.count();
                 return text_response("nobody reads this");
             }},
            {"GET", "/seat",
             [this](const Request& request) {
                 const Seat seat(request.waiting_room);
                 if (!seat.is_taken()) return text_response("no seat");
                 turnstile.pass();
                 return text_response("sat");
             }},
            {"GET", "/stream", [](const Request&) {
                 Response response = text_response("");
                 response.stream = [left = 3](const Write& write) mutable {
                     write("event " + std::to_string(left));
                     return --left > 0;
                 };
                 return response;
             }}};
    }

    std::mutex mutex_;
    std::string failures_;
    std::string run_error_;
    Server server_;
    int port_;
    std::thread thread_;
};

inline std::string get(const std::string& path, const std::string& headers = "") {
    return "GET " + path + " HTTP/1.1\r\nHost: a\r\nConnection: close\r\n" + headers + "\r\n";
}

/// A request after which the connection stays.
inline std::string get_and_stay(const std::string& path, const std::string& headers = "") {
    return "GET " + path + " HTTP/1.1\r\nHost: a\r\n" + headers + "\r\n";
}

inline std::string post(const std::string& headers, const std::string& body) {
    return "POST /echo HTTP/1.1\r\nHost: a\r\nConnection: close\r\n" + headers + "\r\n" + body;
}

}  // namespace lastflat::http
