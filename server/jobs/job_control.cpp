#include "server/jobs/job_control.h"

#include "api/refusal.h"

namespace lastflat::server {

JobRecord found_job(JobStore& jobs, const std::string& owner, const std::string& id) {
    auto job = jobs.find(owner, id);
    if (job) return std::move(*job);
    if (jobs.is_expired(owner, id))
        api::refuse("job_expired", "the job " + id + " was kept as long as jobs are; it is gone");
    api::refuse("job_not_found", "there is no job " + id + "; it may have been deleted");
}

void drop_unneeded(const BlobStore& blobs, JobStore& jobs,
                   const std::vector<std::string>& digests) {
    blobs.remove_unneeded(digests,
                          [&](const std::string& digest) { return jobs.needs_blob(digest); });
}

api::Problem worker_lost_problem() {
    return {"worker_lost",
            "the job was begun three times and its worker was lost each time; post it again, or "
            "send a coarser model"};
}

void JobControl::has_ended(JobNumber job) {
    executor_.cancel(job);
    watch_.changed(job);
}

JobRecord JobControl::cancel(const std::string& owner, const std::string& id) {
    const auto state = jobs_.cancel(owner, id);
    if (!state) (void)found_job(jobs_, owner, id);
    if (state == JobState::succeeded || state == JobState::failed)
        api::refuse("already_finished", "the job has already " + std::string(name(*state)));
    JobRecord job = found_job(jobs_, owner, id);
    has_ended(job.number);
    drop_unneeded(blobs_, jobs_, {job.model});
    return job;
}

void JobControl::remove(const std::string& owner, const std::string& id) {
    const JobNumber job = found_job(jobs_, owner, id).number;
    const auto blobs = jobs_.remove(owner, id);
    has_ended(job);
    if (blobs) drop_unneeded(blobs_, jobs_, *blobs);
}

void JobControl::sweep() {
    const Swept swept = jobs_.sweep(false, worker_lost_problem());
    for (const JobNumber job : swept.changed) has_ended(job);
    drop_unneeded(blobs_, jobs_, swept.blobs);
    if (!swept.changed.empty()) executor_.wake();
}

}  // namespace lastflat::server
