#include "server/serve.h"

#include <signal.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>

#include "server/http/http.h"
#include "server/job_routes.h"
#include "server/run_job.h"
#include "server/stores/memory_store.h"

namespace lastflat::server {
namespace {

/// How long a cancelled job may take to notice: the longest stretch between two of its checks.
constexpr std::chrono::seconds last_grace{5};

/// SIGTERM and SIGINT wait for `sigwait` instead of ending the process; a client that hangs up is
/// no reason to end either.
sigset_t block_signals() {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGTERM);
    sigaddset(&signals, SIGINT);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    signal(SIGPIPE, SIG_IGN);
    return signals;
}

/// Waiting connections are many and cheap: take as many descriptors as the system gives.
void raise_descriptor_limit() {
    rlimit limit{};
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
    limit.rlim_cur = limit.rlim_max;
    setrlimit(RLIMIT_NOFILE, &limit);
}

http::ServerLimits http_limits(const Settings& settings) {
    http::ServerLimits limits;
    limits.body_bytes = settings.max_body_mb << 20;
    limits.all_bodies_bytes = std::max(limits.all_bodies_bytes, limits.body_bytes);
    limits.connections = settings.connections;
    return limits;
}

std::string url_host(const std::string& host) {
    return host.find(':') != std::string::npos && host.front() != '[' ? "[" + host + "]" : host;
}

}  // namespace

void serve(const Settings& settings) {
    const sigset_t signals = block_signals();
    raise_descriptor_limit();
    spdlog::set_default_logger(spdlog::stderr_logger_mt("lastflat"));
    const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
    MemoryLimits memory;
    memory.queued_jobs = settings.queue;
    MemoryStore store(memory);
    WorkerPool workers(
        store, [](const JobInput& input, Progress& progress) { return run_job(input, progress); },
        settings.workers > 0 ? settings.workers : cores);
    http::Server http(
        job_routes(store, workers), http_limits(settings),
        [](int status, std::string_view code, std::string_view detail) {
            return problem_response(
                {status, std::string(code), "", std::string(detail), std::nullopt, std::nullopt});
        },
        [](const http::Request& request, std::string_view what) {
            spdlog::error("{} failed: {}", request.method, what);
        });
    const int port = http.bind(settings.host, settings.port);
    std::exception_ptr failure;
    std::thread listener([&] {
        try {
            http.run();
        } catch (...) {
            failure = std::current_exception();
            kill(getpid(), SIGTERM);  // the service cannot go on without its listener
        }
    });
    std::cout << "listening on http://" << url_host(settings.host) << ":" << port << std::endl;
    int signal = 0;
    sigwait(&signals, &signal);
    spdlog::info("ending: no new work, {} s for what runs", settings.grace_seconds);
    http.stop();
    listener.join();
    if (!workers.stop(std::chrono::seconds(settings.grace_seconds), last_grace)) {
        spdlog::warn("a job did not notice that it was cancelled; it ends with the process");
        spdlog::shutdown();
        std::_Exit(failure ? 1 : 0);
    }
    if (failure) std::rethrow_exception(failure);
}

}  // namespace lastflat::server
