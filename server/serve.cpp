#include "server/serve.h"

#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <semaphore>
#include <thread>

#include "server/crypto.h"
#include "server/housekeeping.h"
#include "server/observe/log.h"
#include "server/routes/access.h"
#include "server/routes/admin_routes.h"
#include "server/routes/answers.h"
#include "server/routes/asset_routes.h"
#include "server/routes/batch_routes.h"
#include "server/routes/document_routes.h"
#include "server/routes/event_stream.h"
#include "server/routes/job_routes.h"
#include "server/routes/result_routes.h"
#include "server/routes/service.h"
#include "server/routes/webhook_routes.h"
#include "server/stores/data_directory.h"
#include "server/stores/sqlite_accounts.h"
#include "server/stores/sqlite_store.h"
#include "server/stores/sqlite_webhooks.h"
#include "server/webhooks/dispatcher.h"

namespace lastflat::server {
namespace {

/// For event streams, to tell their clients that the service ends.
constexpr std::chrono::milliseconds last_words{2000};

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

http::ServerLimits public_limits(const Settings& settings) {
    http::ServerLimits limits;
    limits.body_bytes = settings.max_body_mb << 20;
    limits.all_bodies_bytes = std::max(limits.all_bodies_bytes, limits.body_bytes);
    limits.connections = settings.connections;
    limits.waiting_requests = settings.streams;
    return limits;
}

http::ServerLimits admin_limits() {
    http::ServerLimits limits;
    limits.connections = 4;
    limits.waiting_requests = 0;
    limits.waiting_connections = 64;
    return limits;
}

std::string url_of(const std::string& host, int port) {
    const bool bare_ipv6 = host.find(':') != std::string::npos && host.front() != '[';
    return "http://" + (bare_ipv6 ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

/// A listener on a thread of its own. If it breaks, the service ends.
class Listener {
public:
    Listener(std::vector<http::Route> routes, const http::ServerLimits& limits,
             http::ServerHooks hooks, const Address& address)
        : server_(std::move(routes), limits, std::move(hooks)),
          url_(url_of(address.host, server_.bind(address.host, address.port))) {}
    ~Listener() { stop(); }
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;

    void start() {
        thread_ = std::thread([this] {
            try {
                server_.run();
            } catch (...) {
                failure_ = std::current_exception();
                kill(getpid(), SIGTERM);
            }
        });
    }
    void stop() {
        server_.stop();
        if (thread_.joinable()) thread_.join();
    }
    void rethrow() const {
        if (failure_) std::rethrow_exception(failure_);
    }
    [[nodiscard]] const std::string& url() const { return url_; }

private:
    http::Server server_;
    const std::string url_;
    std::exception_ptr failure_;
    std::thread thread_;
};

http::Response problem(int status, std::string_view code, std::string_view detail) {
    return problem_response(
        {status, std::string(code), "", std::string(detail), std::nullopt, std::nullopt});
}

http::ServerHooks hooks(Metrics& metrics) {
    http::ServerHooks hooks;
    hooks.problem = problem;
    hooks.failed = [](const http::Request& request, std::string_view what) {
        log_event("request_failed",
                  {{"request", request.id}, {"path", request.path}, {"why", what}});
    };
    hooks.answered = [&metrics](const http::AnswerReport& answer) {
        const std::string status = std::to_string(answer.status);
        const std::string_view route = answer.pattern.empty() ? "-" : answer.pattern;
        metrics.count("lastflat_http_requests_total",
                      {{"method", answer.request.method}, {"route", route}, {"status", status}});
        metrics.observe("lastflat_http_request_seconds", answer.seconds, {{"route", route}});
        metrics.count("lastflat_http_received_bytes_total", {},
                      static_cast<double>(answer.bytes_received));
        metrics.count("lastflat_http_sent_bytes_total", {}, static_cast<double>(answer.bytes_sent));
        const bool is_news = answer.status >= 500 ||
                             (answer.request.method != "GET" && answer.request.method != "HEAD");
        if (!is_news || answer.pattern.empty()) return;
        log_event("answer", {{"request", answer.request.id},
                             {"key", answer.request.principal},
                             {"from", answer.request.remote_address},
                             {"method", answer.request.method},
                             {"path", answer.request.path},
                             {"status", answer.status},
                             {"ms", 1000.0 * answer.seconds}});
    };
    return hooks;
}

RunLog run_log(Metrics& metrics, Estimate& estimate) {
    return [&metrics, &estimate](const RunReport& run) {
        metrics.count("lastflat_jobs_ended_total", {{"outcome", run.outcome}});
        metrics.observe("lastflat_job_seconds", run.seconds, {{"outcome", run.outcome}});
        for (const auto& [stage, seconds] : run.stage_seconds)
            metrics.observe("lastflat_job_stage_seconds", seconds, {{"stage", stage}});
        if (run.outcome == "succeeded") estimate.note(run.claim.model_bytes, run.seconds);
        log_event("job_run", {{"job", run.claim.lease.id},
                              {"key", run.claim.owner},
                              {"attempt", run.claim.attempt},
                              {"outcome", run.outcome},
                              {"seconds", run.seconds},
                              {"why", run.why}});
    };
}

ProcessLimits process_limits(const Settings& settings) {
    ProcessLimits limits;
    limits.memory_mb = settings.job_memory_mb;
    limits.time = std::chrono::milliseconds(settings.job_time_ms);
    return limits;
}

int hardware_threads() {
    return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

JobRunner job_runner(const Settings& settings, const BlobStore& blobs) {
    return
        [&blobs, limits = process_limits(settings)](
            const Claim& claim, const std::filesystem::path& file, const ProcessControl& control) {
            WorkOrder order;
            order.model = blobs.path_of(claim.model);
            order.digest = claim.model;
            order.request = claim.request;
            order.result = file;
            order.threads = hardware_threads();
            return run_worker_process(std::move(order), limits, control);
        };
}

/// Few at once: each may use as much as a job.
Validator validator(const Settings& settings, const std::filesystem::path& work) {
    const auto slots = std::make_shared<std::counting_semaphore<>>(2);
    return [slots, work, limits = process_limits(settings)](const std::string& model,
                                                            const std::string& request) {
        slots->acquire();
        const std::unique_ptr<void, std::function<void(void*)>> at_end(
            slots.get(), [&](void*) { slots->release(); });
        WorkOrder order;
        order.validate = true;
        order.digest = sha256(model);
        order.model = work / ("validate-" + new_job_id());
        order.request = request;
        order.threads = hardware_threads();
        write_durably(order.model, model);
        const std::string file = order.model;
        ProcessEnd end = run_worker_process(
            std::move(order), limits, {[](const std::string&, double) {}, [] { return false; }});
        unlink(file.c_str());
        return end;
    };
}

std::vector<http::Route> public_routes(Service& service, WebhookStore& webhooks) {
    std::vector<http::Route> routes = job_routes(service);
    const auto add = [&](std::vector<http::Route> more) {
        routes.insert(routes.end(), std::make_move_iterator(more.begin()),
                      std::make_move_iterator(more.end()));
    };
    add(result_routes(service));
    add({event_route(service)});
    add(asset_routes(service));
    add(batch_routes(service));
    add(webhook_routes(webhooks, service.settings));
    add({health_route(service)});
    add(document_routes());
    add(preflight_routes(routes));
    return routes;
}

}  // namespace

void serve(const Settings& asked) {
    const sigset_t signals = block_signals();
    raise_descriptor_limit();
    start_log();
    Settings settings = asked;
    if (settings.workers == 0) settings.workers = static_cast<std::size_t>(hardware_threads());

    const DataDirectory data(settings.data);
    Metrics metrics;
    SqliteDatabase database(data.database(), [&metrics](bool writes, double seconds) {
        metrics.observe("lastflat_sqlite_seconds", seconds, {{"kind", writes ? "write" : "read"}});
    });
    BlobStore blobs(data.blobs());
    SqliteStore jobs(database, {settings.result_ms, settings.job_ms});
    SqliteAssets assets(database);
    SqliteKeys keys(database);
    SqliteWebhooks webhooks(database);
    JobWatch watch;
    Estimate estimate;
    recover(jobs, blobs);
    WorkerPool workers(jobs, blobs, watch, {settings.workers, settings.lease_ms, data.work()},
                       job_runner(settings, blobs), run_log(metrics, estimate));
    Service service{settings,
                    jobs,
                    assets,
                    keys,
                    blobs,
                    watch,
                    workers,
                    estimate,
                    metrics,
                    validator(settings, data.work()),
                    keys.secret("cursor")};
    Housekeeping housekeeping(service);
    std::optional<WebhookDispatcher> dispatcher;
    if (settings.webhooks != WebhookTargets::none) {
        const bool anywhere = settings.webhooks == WebhookTargets::anywhere;
        dispatcher.emplace(
            webhooks, [anywhere](const DueDelivery& due) { return post_message(due, anywhere); });
    }
    Access access(keys, settings);
    http::ServerHooks public_hooks = hooks(metrics);
    public_hooks.admit = [&access](http::Request& request) { return access.admit(request); };
    std::optional<Listener> admin;
    if (settings.admin)
        admin.emplace(admin_routes(service), admin_limits(), hooks(metrics), *settings.admin);
    Listener main(public_routes(service, webhooks), public_limits(settings), public_hooks,
                  settings.listen);
    if (!keys.has_keys())
        log_event("open", {{"why",
                            "there is no API key: clients on this machine need none, others "
                            "get no answer; make one with lastflat keys add NAME"}});
    main.start();
    if (admin) {
        admin->start();
        std::cout << "admin on " << admin->url() << "\n";
    }
    std::cout << "listening on " << main.url() << std::endl;

    int signal = 0;
    sigwait(&signals, &signal);
    log_event("ending", {{"grace_s", static_cast<double>(settings.grace_ms) / 1000.0}});
    service.draining = true;
    workers.stop(std::chrono::milliseconds(settings.grace_ms));
    watch.close(last_words);
    main.stop();
    if (admin) admin->stop();
    log_event("ended");
    main.rethrow();
    if (admin) admin->rethrow();
}

}  // namespace lastflat::server
