// Jobs as their clients see them.
#pragma once

#include "server/jobs/estimate.h"
#include "server/jobs/job.h"
#include "server/jobs/job_watch.h"

namespace lastflat::server {

class JobView {
public:
    /// Both must outlive it. `workers`: how many jobs run at once.
    JobView(const JobWatch& watch, const Estimate& estimate, std::size_t workers)
        : watch_(watch), estimate_(estimate), workers_(workers) {}

    [[nodiscard]] api::Job of(const JobRecord& job) const;
    /// Changes with every change of state and every step of the progress.
    [[nodiscard]] std::string etag(const JobRecord& job) const;

private:
    const JobWatch& watch_;
    const Estimate& estimate_;
    const std::size_t workers_;
};

}  // namespace lastflat::server
