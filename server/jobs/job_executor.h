// Who runs jobs, as those see it who add and end them.
#pragma once

#include "server/jobs/job.h"

namespace lastflat::server {

/// Both calls are hints, from any thread: the store says what is to be done.
class JobExecutor {
public:
    virtual ~JobExecutor() = default;
    /// Says that a job was queued.
    virtual void wake() = 0;
    /// Ends a run at once; the store must already say that the job is canceling or gone.
    virtual void cancel(JobNumber job) = 0;
};

}  // namespace lastflat::server
