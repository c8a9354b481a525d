// Waiting for a job, and answering with it.
#pragma once

#include "server/http/http.h"
#include "server/jobs/job_store.h"
#include "server/jobs/job_watch.h"
#include "server/routes/job_view.h"
#include "server/routes/waiting_seat.h"

namespace lastflat::server {

class JobWait {
public:
    /// All must outlive it.
    JobWait(JobStore& jobs, JobWatch& watch, SeatsByKey& seats, const JobView& view)
        : jobs_(jobs), watch_(watch), seats_(seats), view_(view) {}

    /// Waits until the job has ended, or differs from what the client has, or the time is over.
    [[nodiscard]] JobRecord wait(const http::Request& request, JobRecord job, int seconds) const;

private:
    JobStore& jobs_;
    JobWatch& watch_;
    SeatsByKey& seats_;
    const JobView& view_;
};

/// The job; with Retry-After while it has not ended.
[[nodiscard]] http::Response job_response(const JobView& view, const JobRecord& job, int status);

}  // namespace lastflat::server
