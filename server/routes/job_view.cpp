#include "server/routes/job_view.h"

#include <algorithm>

#include "server/support/clock.h"

namespace lastflat::server {

api::Job JobView::of(const JobRecord& record) const {
    api::Job job;
    job.id = record.id;
    job.state = record.state;
    if (record.state == JobState::canceling || record.state == JobState::canceled)
        job.reason = record.reason;
    job.tag = record.tag;
    job.batch = record.batch;
    job.priority = record.priority;
    job.created_ms = record.created_ms;
    job.started_ms = record.started_ms;
    job.finished_ms = record.finished_ms;
    job.cancel_at_ms = is_final(record.state) ? std::nullopt : record.cancel_at_ms;
    job.result_expires_ms = record.result_expires_ms;
    job.expires_ms = record.expires_ms;
    job.attempt = record.attempt;
    job.cached = record.state == JobState::succeeded && record.attempt == 0;
    job.queue_position = record.queue_position;
    job.error = record.error;
    if (record.state == JobState::succeeded) job.percent = 100;
    if (record.state == JobState::running) {
        if (const auto progress = watch_.progress(record.number)) {
            job.stage = progress->stage;
            job.percent = static_cast<int>(100.0 * progress->fraction);
        }
        if (const auto whole = estimate_.seconds(record.model_bytes)) {
            const double spent = static_cast<double>(now_ms() - *record.started_ms) / 1000.0;
            job.remaining_s = std::max(0.0, *whole - spent);
        }
    }
    if (record.queue_position) {
        if (const auto each = estimate_.seconds()) {
            const auto workers = static_cast<double>(std::max<std::size_t>(1, workers_));
            job.queue_s = *each * static_cast<double>(*record.queue_position) / workers;
        }
    }
    return job;
}

std::string JobView::etag(const JobRecord& job) const {
    std::string tag = "W/\"" + std::to_string(job.revision);
    const auto progress = watch_.progress(job.number);
    if (progress && job.state == JobState::running) tag += "." + std::to_string(progress->number);
    return tag + "\"";
}

}  // namespace lastflat::server
