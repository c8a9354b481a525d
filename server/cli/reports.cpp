#include "server/cli/reports.h"

#include "server/support/log.h"

namespace lastflat::server {

http::AnswerLog answer_log(Metrics& metrics) {
    return [&metrics](const http::AnswerReport& answer) {
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
}

RunLog run_log(Metrics& metrics, Estimate& estimate) {
    return [&metrics, &estimate](const RunReport& run) {
        metrics.count("lastflat_jobs_ended_total", {{"outcome", run.outcome}});
        metrics.observe("lastflat_job_seconds", run.seconds, {{"outcome", run.outcome}});
        for (const auto& [stage, seconds] : run.stage_seconds)
            metrics.observe("lastflat_job_stage_seconds", seconds, {{"stage", stage}});
        if (run.outcome == "succeeded") estimate.note(run.claim.model_bytes, run.seconds);
        log_event("job_run", {{"job", run.claim.id},
                              {"key", run.claim.owner},
                              {"attempt", run.claim.attempt},
                              {"outcome", run.outcome},
                              {"seconds", run.seconds},
                              {"why", run.why}});
    };
}

SqliteClock sqlite_clock(Metrics& metrics) {
    return [&metrics](bool writes, double seconds) {
        metrics.observe("lastflat_sqlite_seconds", seconds, {{"kind", writes ? "write" : "read"}});
    };
}

}  // namespace lastflat::server
