// Who waits for a job, and how far it is. Nothing here must last: a job's truth is in the store.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "server/jobs/job.h"

namespace lastflat::server {

struct LiveProgress {
    std::string stage;        ///< of the flattening
    double fraction = 0.0;    ///< of the whole job
    std::int64_t number = 0;  ///< grows with every step of this attempt
};

class JobWatch {
public:
    using Clock = std::chrono::steady_clock;

    /// Says that a job's row has changed. Any thread, after the change.
    void changed(JobNumber job);
    /// Says how far a running job is.
    void reach(JobNumber job, const std::string& stage, double fraction);
    /// The job does not run any more.
    void ended(JobNumber job);
    [[nodiscard]] std::optional<LiveProgress> progress(JobNumber job) const;

    /// Nobody waits any longer from now on: the service ends. Gives those who did `grace` to say so
    /// to their clients.
    void close(std::chrono::milliseconds grace);
    [[nodiscard]] bool is_closed() const;

    /// Notices every change from its construction on.
    class Subscription {
    public:
        Subscription(JobWatch& watch, JobNumber job);
        ~Subscription();
        Subscription(const Subscription&) = delete;
        Subscription& operator=(const Subscription&) = delete;
        /// Waits for a change since the construction or the last call. False: there was none until
        /// `deadline`, or the watch was closed.
        [[nodiscard]] bool wait_until(Clock::time_point deadline);

    private:
        JobWatch& watch_;
        const JobNumber job_;
        std::uint64_t seen_ = 0;
    };

private:
    struct Entry {
        std::uint64_t version = 0;
        int subscriptions = 0;
        std::optional<LiveProgress> progress;
    };
    void touch(Entry& entry);
    void drop_if_idle(std::map<JobNumber, Entry>::iterator entry);

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::map<JobNumber, Entry> entries_;
    std::size_t subscriptions_ = 0;
    bool closed_ = false;
};

}  // namespace lastflat::server
