// Batches as their clients see them, and waiting for them.
#pragma once

#include "server/http/http.h"
#include "server/jobs/job_store.h"
#include "server/jobs/job_watch.h"
#include "server/routes/job_view.h"
#include "server/routes/waiting_seat.h"

namespace lastflat::server {

/// After so long a batch is looked at again while somebody waits for it, at the latest.
inline constexpr std::chrono::milliseconds look_at_batch{200};

class BatchView {
public:
    /// All must outlive it.
    BatchView(JobStore& jobs, const JobView& view, JobWatch& watch, SeatsByKey& seats)
        : jobs_(jobs), view_(view), watch_(watch), seats_(seats) {}

    /// Throws: api::Refusal (404); StoreError.
    [[nodiscard]] BatchRecord found(const http::Request& request, const std::string& id) const;
    /// Those that are left, in their order.
    [[nodiscard]] std::vector<JobRecord> jobs_of(const BatchRecord& batch) const;
    [[nodiscard]] api::Job of(const JobRecord& job) const { return view_.of(job); }
    [[nodiscard]] std::string json(const BatchRecord& batch) const;
    /// Waits until the batch has finished or the time is over. Takes a seat, if there is one.
    [[nodiscard]] BatchRecord wait(const http::Request& request, BatchRecord batch,
                                   int seconds) const;

private:
    JobStore& jobs_;
    const JobView& view_;
    JobWatch& watch_;
    SeatsByKey& seats_;
};

}  // namespace lastflat::server
