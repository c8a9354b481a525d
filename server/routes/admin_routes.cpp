#include "server/routes/admin_routes.h"

#include "api/health.h"
#include "api/refusal.h"
#include "server/routes/answers.h"
#include "server/support/clock.h"
#include "server/support/version.h"

namespace lastflat::server {
namespace {

/// A store that fails is said, but is no reason to restart the process: the answer is still 200.
http::Response health(const AdminServices& service) {
    api::Health health{service.draining ? api::Status::draining : api::Status::ok, version, {}};
    try {
        const JobCounts counts = service.jobs.counts();
        health.jobs = {counts.queued, counts.running};
    } catch (const StoreError&) {
        health.status = api::Status::store_unavailable;
    }
    return json_response(200, to_json(health));
}

http::Response readiness(const AdminServices& service) {
    service.check_storage();
    const JobCounts counts = service.jobs.counts();
    if (service.draining) api::refuse("draining", "the service is ending");
    return json_response(
        200, to_json(api::Health{
                 api::Status::ready, {}, api::Health::Jobs{counts.queued, counts.running}}));
}

http::Response metrics(const AdminServices& service) {
    const JobCounts counts = service.jobs.counts();
    Metrics& metrics = service.metrics;
    metrics.set("lastflat_jobs_queued", static_cast<double>(counts.queued));
    metrics.set("lastflat_jobs_running", static_cast<double>(counts.running));
    metrics.set("lastflat_queue_age_seconds",
                counts.oldest_queued_ms
                    ? static_cast<double>(now_ms() - *counts.oldest_queued_ms) / 1000.0
                    : 0.0);
    metrics.set("lastflat_workers", static_cast<double>(service.workers));
    metrics.set("lastflat_workers_busy", static_cast<double>(service.busy_workers()));
    http::Response response = json_response(200, metrics.text());
    response.media_type = "text/plain; version=0.0.4; charset=utf-8";
    return response;
}

}  // namespace

http::Route health_route(const AdminServices& service) {
    return {"GET", "/healthz", [service](const http::Request&) { return health(service); }, false,
            true};
}

std::vector<http::Route> admin_routes(const AdminServices& service) {
    return {health_route(service),
            {"GET", "/readyz", [service](const http::Request&) { return readiness(service); }},
            {"GET", "/metrics", [service](const http::Request&) { return metrics(service); }},
            {"GET", "/version",
             [](const http::Request&) { return json_response(200, api::version_json(version)); }}};
}

}  // namespace lastflat::server
