// What has to be done now and then, whatever clients ask.
#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

#include "server/jobs/job_control.h"
#include "server/support/metrics.h"

namespace lastflat::server {

/// Before anything runs: jobs that were running when the process ended go back to the queue (this
/// process holds the data, so nobody works on them), and blobs that no row knows are removed.
/// Returns how many jobs there were.
std::size_t recover(JobStore& jobs, const BlobStore& blobs);

/// A thread that sweeps once a second.
class Housekeeping {
public:
    /// All must outlive it.
    Housekeeping(JobControl& control, const BlobStore& blobs, Metrics& metrics);
    ~Housekeeping();
    Housekeeping(const Housekeeping&) = delete;
    Housekeeping& operator=(const Housekeeping&) = delete;

private:
    void sweep();
    /// What takes too long for every second.
    void look_slowly();

    JobControl& control_;
    const BlobStore& blobs_;
    Metrics& metrics_;
    std::size_t sweeps_ = 0;
    std::mutex mutex_;
    std::condition_variable ended_;
    bool ending_ = false;
    std::thread thread_;
};

}  // namespace lastflat::server
