// Finding and ending jobs: in the store, where they run, and for those who watch them.
#pragma once

#include "server/jobs/blob_store.h"
#include "server/jobs/job_executor.h"
#include "server/jobs/job_store.h"
#include "server/jobs/job_watch.h"

namespace lastflat::server {

/// The job; a 404 or 410 refusal if the owner has none of that id.
[[nodiscard]] JobRecord found_job(JobStore& jobs, const std::string& owner, const std::string& id);

/// Removes those of the blobs that no row needs any more.
void drop_unneeded(const BlobStore& blobs, JobStore& jobs, const std::vector<std::string>& digests);

/// What a job ends with whose worker was lost for the last time.
[[nodiscard]] api::Problem worker_lost_problem();

/// Safe from any thread; every call may throw StoreError.
class JobControl {
public:
    /// All must outlive it.
    JobControl(JobStore& jobs, const BlobStore& blobs, JobWatch& watch, JobExecutor& executor)
        : jobs_(jobs), blobs_(blobs), watch_(watch), executor_(executor) {}

    /// The job after that: canceled, or canceling until its run has ended.
    /// Throws: api::Refusal (404, 409, 410).
    [[nodiscard]] JobRecord cancel(const std::string& owner, const std::string& id);
    /// Forgets the job in whatever state it is. Throws: api::Refusal (404, 410).
    void remove(const std::string& owner, const std::string& id);
    /// Ends lost leases and overdue jobs, and forgets what is past its time.
    void sweep();

private:
    /// The store has ended it.
    void has_ended(JobNumber job);

    JobStore& jobs_;
    const BlobStore& blobs_;
    JobWatch& watch_;
    JobExecutor& executor_;
};

}  // namespace lastflat::server
