// Runners: threads that claim jobs and see each through its worker.
#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

#include "server/jobs/blob_store.h"
#include "server/jobs/job_executor.h"
#include "server/jobs/job_store.h"
#include "server/jobs/job_watch.h"
#include "server/runner/worker_process.h"

namespace lastflat::server {

/// Runs one claimed job to its end; its result, if any, is in `file`.
using RunJob = std::function<ProcessEnd(const Claim& claim, const std::filesystem::path& file,
                                        const ProcessControl& control)>;

/// Told of every end of a run. Any of the pool's threads.
struct RunReport {
    Claim claim;
    std::string outcome;  ///< the job's state now, or "lost"
    std::string why;      ///< for the operator
    double seconds = 0.0;
    std::map<std::string, double> stage_seconds;
};
using RunLog = std::function<void(const RunReport&)>;

struct PoolOptions {
    std::size_t workers = 1;  ///< at once, each with a runner
    std::int64_t lease_ms = 60'000;
    std::filesystem::path work;  ///< a folder on the file system of the blobs
};

class RunnerPool final : public JobExecutor {
public:
    /// All must outlive the pool.
    RunnerPool(JobStore& store, const BlobStore& blobs, JobWatch& watch, PoolOptions options,
               RunJob run_job, RunLog log);
    ~RunnerPool() override;

    void wake() override;
    void cancel(JobNumber job) override;
    [[nodiscard]] std::size_t busy() const;

    /// Takes no more jobs.
    void drain();
    /// Waits until nothing runs, `grace` at most; then ends what runs and gives it back to the
    /// queue. Ends the threads.
    void stop(std::chrono::milliseconds grace);

private:
    struct Run {
        JobNumber job = 0;
        bool canceled = false;
    };
    void work();
    [[nodiscard]] std::optional<Claim> try_claim();
    void run(const Claim& claim);
    [[nodiscard]] bool must_stop(const Claim& claim, std::int64_t& renewed_ms);
    [[nodiscard]] std::optional<JobState> settle(const Claim& claim, const ProcessEnd& run,
                                                 const std::filesystem::path& file);
    /// Tries until the store can; false if the service ends before it could.
    [[nodiscard]] bool persist(const std::function<void()>& change);

    JobStore& store_;
    const BlobStore& blobs_;
    JobWatch& watch_;
    const PoolOptions options_;
    const RunJob run_job_;
    const RunLog log_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::map<std::int64_t, Run> running_;  ///< by the lease's token
    std::uint64_t wakes_ = 0;
    bool draining_ = false;
    bool stopping_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace lastflat::server
