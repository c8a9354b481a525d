#include "server/cli/serve.h"

#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <iostream>

#include "server/cli/listener.h"
#include "server/cli/reports.h"
#include "server/jobs/housekeeping.h"
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
#include "server/storage/data_directory.h"
#include "server/storage/sqlite_accounts.h"
#include "server/storage/sqlite_store.h"
#include "server/storage/sqlite_webhooks.h"
#include "server/support/log.h"
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

http::ServerHooks hooks(Metrics& metrics) {
    http::ServerHooks hooks;
    hooks.problem = [](int status, std::string_view code, std::string_view detail) {
        return problem_response(
            {status, std::string(code), "", std::string(detail), std::nullopt, std::nullopt});
    };
    hooks.failed = failure_log();
    hooks.answered = answer_log(metrics);
    return hooks;
}

Settings with_workers(Settings settings) {
    if (settings.workers == 0) settings.workers = static_cast<std::size_t>(hardware_threads());
    return settings;
}

/// Everything that the service consists of. A member uses only those above it.
class App {
public:
    explicit App(const Settings& settings)
        : settings_(with_workers(settings)),
          data_(settings.data),
          database_(data_.database(), sqlite_clock(metrics_)),
          blobs_(data_.blobs()),
          jobs_(database_, {settings.result_ms, settings.job_ms}),
          recovered_jobs_(recover(jobs_, blobs_)),
          workers_(jobs_, blobs_, watch_, {settings_.workers, settings.lease_ms, data_.work()},
                   job_runner(settings_, blobs_), run_log(metrics_, estimate_)),
          service_{settings_,
                   jobs_,
                   assets_,
                   keys_,
                   blobs_,
                   watch_,
                   workers_,
                   estimate_,
                   metrics_,
                   inquiry(settings_, data_.work(), [this] { return watch_.is_closed(); }),
                   keys_.secret("cursor")},
          housekeeping_(service_) {
        if (settings_.webhooks != WebhookTargets::none) {
            const bool anywhere = settings_.webhooks == WebhookTargets::anywhere;
            dispatcher_.emplace(webhooks_, [anywhere](const DueDelivery& due) {
                return post_message(due, anywhere);
            });
        }
        http::ServerHooks with_access = hooks(metrics_);
        with_access.admit = [this](http::Request& request) { return access_.admit(request); };
        with_access.origin_headers = [this](std::string_view origin) {
            return access_.origin_headers(origin);
        };
        main_.emplace(public_routes(service_, webhooks_), public_limits(settings_), with_access,
                      settings_.listen);
        if (settings_.admin)
            admin_.emplace(admin_routes(service_), admin_limits(), hooks(metrics_),
                           *settings_.admin);
    }

    void start() {
        log_event("started", {{"recovered_jobs", recovered_jobs_}});
        if (!keys_.has_keys())
            log_event("open",
                      {{"why",
                        "there is no API key: clients on this machine need none, others get "
                        "no answer; make one with lastflat keys add NAME"}});
        main_->start();
        if (admin_) {
            admin_->start();
            std::cout << "admin on " << admin_->url() << "\n";
        }
        std::cout << "listening on " << main_->url() << std::endl;
    }

    void stop() {
        service_.draining = true;
        workers_.stop(std::chrono::milliseconds(settings_.grace_ms));
        watch_.close(last_words);
        main_->stop();
        if (admin_) admin_->stop();
        main_->rethrow();
        if (admin_) admin_->rethrow();
    }

private:
    const Settings settings_;
    const DataDirectory data_;
    Metrics metrics_;
    SqliteDatabase database_;
    BlobStore blobs_;
    SqliteStore jobs_;
    SqliteAssets assets_{database_};
    SqliteKeys keys_{database_};
    SqliteWebhooks webhooks_{database_};
    JobWatch watch_;
    Estimate estimate_;
    const std::size_t recovered_jobs_;  ///< before any worker begins
    WorkerPool workers_;
    Service service_;
    Housekeeping housekeeping_;
    std::optional<WebhookDispatcher> dispatcher_;
    Access access_{keys_, settings_};
    std::optional<Listener> main_, admin_;
};

}  // namespace

void serve(const Settings& settings) {
    const sigset_t signals = block_signals();
    umask(S_IRWXG | S_IRWXO);  // models, requests and secrets are nobody else's
    raise_descriptor_limit();
    start_log();
    App app(settings);
    app.start();
    int signal = 0;
    sigwait(&signals, &signal);
    log_event("ending", {{"grace_s", static_cast<double>(settings.grace_ms) / 1000.0}});
    app.stop();
    log_event("ended");
}

}  // namespace lastflat::server
