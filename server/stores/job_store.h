// Where jobs are kept. Every call is safe from any thread and takes effect as a whole.
#pragma once

#include "server/jobs/job.h"

namespace lastflat::server {

struct Claim {
    std::string id;
    JobInput input;
};

struct JobCounts {
    std::size_t queued = 0, running = 0;
};

class JobStore {
public:
    virtual ~JobStore() = default;

    /// Keeps a new job as queued; false if the queue is full and nothing was kept.
    [[nodiscard]] virtual bool add(const std::string& id, JobInput input) = 0;
    [[nodiscard]] virtual std::optional<JobRecord> find(const std::string& id) const = 0;

    /// The oldest queued job becomes running and is the caller's to finish.
    [[nodiscard]] virtual std::optional<Claim> claim() = 0;
    /// Ends a running job; one that is being cancelled ends as canceled whatever the outcome. A job
    /// that was removed meanwhile is left alone.
    virtual void finish(const std::string& id, JobOutcome outcome) = 0;

    /// queued becomes canceled, running becomes canceling; other states stay. Returns the state
    /// after the call; nothing if there is no such job.
    [[nodiscard]] virtual std::optional<JobState> cancel(const std::string& id) = 0;
    /// Forgets a job in whatever state. False if there is no such job.
    [[nodiscard]] virtual bool remove(const std::string& id) = 0;

    [[nodiscard]] virtual JobCounts counts() const = 0;
};

}  // namespace lastflat::server
