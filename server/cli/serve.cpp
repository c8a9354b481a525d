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
#include "server/routes/batch_events.h"
#include "server/routes/batch_results.h"
#include "server/routes/batch_routes.h"
#include "server/routes/document_routes.h"
#include "server/routes/event_stream.h"
#include "server/routes/job_list.h"
#include "server/routes/job_routes.h"
#include "server/routes/own_machine.h"
#include "server/routes/result_routes.h"
#include "server/routes/session_routes.h"
#include "server/routes/submit_routes.h"
#include "server/routes/token_routes.h"
#include "server/routes/validate_route.h"
#include "server/routes/webhook_routes.h"
#include "server/runner/in_worker.h"
#include "server/storage/blob_folder.h"
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
    limits.trusted_proxies = settings.trusted_proxies;
    return limits;
}

http::ServerLimits admin_limits() {
    http::ServerLimits limits;
    limits.connections = 4;
    limits.waiting_requests = 0;
    limits.waiting_connections = 64;
    return limits;
}

http::ServerHooks hooks(Metrics& metrics) {
    http::ServerHooks hooks;
    hooks.problem = answer_to;
    hooks.answered = answer_log(metrics);
    return hooks;
}

Settings with_workers(Settings settings) {
    if (settings.workers == 0) settings.workers = static_cast<std::size_t>(hardware_threads());
    return settings;
}

ProcessLimits process_limits(const Settings& settings) {
    ProcessLimits limits;
    limits.memory_mb = settings.job_memory_mb;
    limits.time = std::chrono::milliseconds(settings.job_time_ms);
    return limits;
}

SessionLimits session_limits(const Settings& settings) {
    SessionLimits limits{settings.sessions, settings.sessions_per_key,
                         std::chrono::milliseconds(settings.session_idle_ms),
                         process_limits(settings)};
    limits.process.memory_mb = settings.session_memory_mb;
    return limits;
}

/// Everything that the service consists of. A member uses only those above it.
class App {
public:
    explicit App(const Settings& settings) : settings_(with_workers(settings)) {
        if (settings_.webhooks != WebhookTargets::none) {
            const bool anywhere = settings_.webhooks == WebhookTargets::anywhere;
            dispatcher_.emplace(webhooks_, [anywhere](const DueDelivery& due) {
                return post_message(due, anywhere);
            });
        }
        http::ServerHooks with_access = hooks(metrics_);
        with_access.admit = [this](http::Request& request) { access_.admit(request); };
        with_access.origin_headers = [this](std::string_view origin) {
            return access_.origin_headers(origin);
        };
        main_.emplace(public_routes(), public_limits(settings_), with_access, settings_.listen);
        if (settings_.admin)
            admin_.emplace(admin_routes(admin_services_), admin_limits(), admin_hooks(),
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
        draining_ = true;
        sessions_.stop();
        maps_.stop();
        runners_.stop(std::chrono::milliseconds(settings_.grace_ms));
        watch_.close(last_words);
        main_->stop();
        if (admin_) admin_->stop();
        main_->rethrow();
        if (admin_) admin_->rethrow();
    }

private:
    [[nodiscard]] std::vector<http::Route> public_routes() {
        std::vector<http::Route> routes = submit_routes({intake_, blobs_, view_, wait_});
        const auto add = [&](std::vector<http::Route> more) {
            routes.insert(routes.end(), std::make_move_iterator(more.begin()),
                          std::make_move_iterator(more.end()));
        };
        add({job_list_route(jobs_, view_, keys_.secret("cursor"))});
        add(job_routes({jobs_, control_, view_, wait_}));
        add(result_routes({jobs_, blobs_, tasks_, maps_, seats_}));
        add({event_route({jobs_, blobs_, watch_, view_, seats_})});
        add(asset_routes({assets_, blobs_, jobs_, settings_.assets_per_key_mb,
                          settings_.storage_per_key_mb, settings_.min_free_mb}));
        add({validate_route({assets_, blobs_, tasks_, draining_})});
        add(batch_routes({intake_, control_, batches_}));
        add(batch_result_routes({batches_, blobs_}));
        add({batch_event_route({batches_, watch_, seats_})});
        add(session_routes(
            {sessions_, intake_, assets_, blobs_, view_, seats_, settings_.min_free_mb}));
        add(webhook_routes(webhooks_, settings_.webhooks != WebhookTargets::none));
        add({token_route(tokens_)});
        add({health_route(admin_services_)});
        add(document_routes());
        return routes;
    }

    /// On this machine's own address metrics are its user's alone; elsewhere probes ask by address.
    [[nodiscard]] http::ServerHooks admin_hooks() {
        http::ServerHooks with_pages = hooks(metrics_);
        if (!is_loopback(settings_.admin->host)) return with_pages;
        with_pages.admit = [this](http::Request& request) {
            if (request.path == "/metrics") check_page(request, settings_.admin->host, {});
        };
        return with_pages;
    }

    /// Nothing is changed if the database is not as it should be.
    [[nodiscard]] std::size_t recovered() {
        database_.require_sound();
        mark_database(data_.folder(), keys_.secret("database"));
        return recover(jobs_, blobs_);
    }

    const Settings settings_;
    std::atomic<bool> draining_{false};
    const DataDirectory data_{settings_.data};
    Metrics metrics_;
    SqliteDatabase database_{sound_database(data_.folder()), sqlite_clock(metrics_)};
    const BlobFolder blobs_{data_.blobs()};
    SqliteStore jobs_{database_, {settings_.result_ms, settings_.job_ms}};
    SqliteAssets assets_{database_};
    SqliteKeys keys_{database_};
    SqliteWebhooks webhooks_{database_};
    JobWatch watch_;
    Estimate estimate_;
    const std::size_t recovered_jobs_ = recovered();  ///< before any runner begins
    const ProcessLimits limits_ = process_limits(settings_);
    RunnerPool runners_{jobs_,
                        blobs_,
                        watch_,
                        {settings_.workers, settings_.lease_ms, data_.work()},
                        run_jobs_in_workers(limits_, blobs_),
                        run_log(metrics_, estimate_)};
    JobControl control_{jobs_, blobs_, watch_, runners_};
    JobIntake intake_{jobs_,
                      assets_,
                      blobs_,
                      runners_,
                      {{settings_.queue, settings_.queue_per_key,
                        std::uint64_t{settings_.storage_per_key_mb} << 20},
                       settings_.min_free_mb,
                       settings_.webhooks != WebhookTargets::none},
                      draining_};
    Housekeeping housekeeping_{control_, blobs_, metrics_};
    std::optional<WebhookDispatcher> dispatcher_;
    SeatsByKey seats_{settings_.streams};
    const TaskAnswers tasks_{
        seats_, run_tasks_in_workers(limits_, data_.work(), [this] { return watch_.is_closed(); })};
    ResidentMaps maps_{limits_, data_.work()};
    LiveSessions sessions_{session_limits(settings_), data_.work()};
    const JobView view_{watch_, estimate_, settings_.workers};
    const JobWait wait_{jobs_, watch_, seats_, view_};
    const BatchView batches_{jobs_, view_, watch_, seats_};
    const AdminServices admin_services_{jobs_,
                                        metrics_,
                                        draining_,
                                        settings_.workers,
                                        [this] { return runners_.busy(); },
                                        [this] {
                                            database_.check();
                                            blobs_.check();
                                        }};
    const Tokens tokens_{keys_.secret("tokens")};
    Access access_{
        keys_,
        jobs_,
        tokens_,
        {settings_.rate, settings_.allowed_origins, settings_.listen.host, settings_.session_rate}};
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
