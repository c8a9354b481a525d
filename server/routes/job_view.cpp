#include "server/routes/job_view.h"

#include <algorithm>

#include "api/job.h"
#include "server/routes/answers.h"
#include "server/support/clock.h"
#include "server/support/crypto.h"

namespace lastflat::server {

JobRecord found_job(const Service& service, const std::string& owner, const std::string& id) {
    auto job = service.jobs.find(owner, id);
    if (job) return std::move(*job);
    if (service.jobs.is_expired(owner, id))
        refuse(410, "job_expired", "the job " + id + " was kept as long as jobs are; it is gone");
    refuse(404, "job_not_found", "there is no job " + id + "; it may have been deleted");
}

std::string job_json(const Service& service, const JobRecord& record) {
    api::Job job;
    job.id = record.id;
    job.state = name(record.state);
    if (record.state == JobState::canceling || record.state == JobState::canceled)
        job.reason = record.reason;
    job.tag = record.tag;
    job.batch = record.batch;
    job.created_ms = record.created_ms;
    job.started_ms = record.started_ms;
    job.finished_ms = record.finished_ms;
    job.cancel_at_ms = is_final(record.state) ? std::nullopt : record.cancel_at_ms;
    job.result_expires_ms = record.result_expires_ms;
    job.expires_ms = record.expires_ms;
    job.attempt = record.attempt;
    job.queue_position = record.queue_position;
    job.error = record.error;
    job.stage = job.state;
    if (record.state == JobState::succeeded) job.percent = 100;
    if (record.state == JobState::running) {
        if (const auto progress = service.watch.progress(record.id)) {
            job.stage = progress->stage;
            job.percent = static_cast<int>(100.0 * progress->fraction);
        }
        if (const auto whole = service.estimate.seconds(record.model_bytes)) {
            const double spent = static_cast<double>(now_ms() - *record.started_ms) / 1000.0;
            job.remaining_s = std::max(0.0, *whole - spent);
        }
    }
    if (record.queue_position) {
        if (const auto each = service.estimate.seconds()) {
            const auto workers =
                static_cast<double>(std::max<std::size_t>(1, service.settings.workers));
            job.queue_s = *each * static_cast<double>(*record.queue_position) / workers;
        }
    }
    return api::to_json(job);
}

std::string job_etag(const Service& service, const JobRecord& job) {
    std::string tag = "W/\"" + std::to_string(job.revision);
    const auto progress = service.watch.progress(job.id);
    if (progress && job.state == JobState::running) tag += "." + std::to_string(progress->number);
    return tag + "\"";
}

const ResultPart& result_part(const JobRecord& job, std::string_view format, bool gzip) {
    for (const ResultPart& part : job.parts) {
        if (part.format == format && part.gzip == gzip) return part;
    }
    throw CorruptBlob("the result of " + job.id + " has no part " + std::string(format));
}

std::string result_bytes(const Service& service, const JobRecord& job, const ResultPart& part) {
    std::string bytes = service.blobs.read(job.result, part.offset, part.size);
    if (sha256(bytes) != part.digest)
        throw CorruptBlob("the result of " + job.id + " has other bytes");
    return bytes;
}

}  // namespace lastflat::server
