// Threads that take jobs from a store and run them.
#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

#include "core/progress.h"
#include "server/stores/job_store.h"

namespace lastflat::server {

/// Runs one job. Never throws: whatever happens is an outcome.
using JobRunner = std::function<JobOutcome(const JobInput&, Progress&)>;

class WorkerPool {
public:
    WorkerPool(JobStore& store, JobRunner runner, std::size_t workers);
    /// Cancels what runs and waits for it, as long as it takes.
    ~WorkerPool();

    /// Says that a job was added.
    void wake();
    /// Asks a running job to stop; it does at its next check.
    void cancel(const std::string& id);
    /// How far a running job is; nothing if it does not run here.
    [[nodiscard]] std::optional<std::pair<Stage, double>> progress(const std::string& id) const;

    /// Takes no more jobs, lets running ones finish for `grace`, then cancels them and gives them
    /// `last_grace` to notice. False if one still runs; then only ending the process ends it.
    [[nodiscard]] bool stop(std::chrono::milliseconds grace, std::chrono::milliseconds last_grace);

private:
    void work();

    JobStore& store_;
    const JobRunner runner_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::map<std::string, std::shared_ptr<Progress>> running_;
    bool stopping_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace lastflat::server
