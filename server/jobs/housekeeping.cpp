#include "server/jobs/housekeeping.h"

#include <malloc.h>

#include "server/support/log.h"

namespace lastflat::server {
namespace {

constexpr std::chrono::seconds interval{1};
constexpr std::size_t sweeps_between_trims = 5, sweeps_between_slow_looks = 30;

}  // namespace

std::size_t recover(JobStore& jobs, const BlobStore& blobs) {
    const Swept swept = jobs.sweep(true, worker_lost_problem());
    drop_unneeded(blobs, jobs, blobs.all());
    return swept.changed.size();
}

Housekeeping::Housekeeping(JobControl& control, const BlobStore& blobs, Metrics& metrics)
    : control_(control), blobs_(blobs), metrics_(metrics), thread_([this] {
          std::unique_lock lock(mutex_);
          while (!ended_.wait_for(lock, interval, [this] { return ending_; })) sweep();
      }) {}

Housekeeping::~Housekeeping() {
    {
        const std::scoped_lock lock(mutex_);
        ending_ = true;
    }
    ended_.notify_all();
    thread_.join();
}

void Housekeeping::sweep() {
    // What a burst of large bodies left behind goes back to the system.
    if (sweeps_ % sweeps_between_trims == 0) malloc_trim(0);
    try {
        if (sweeps_++ % sweeps_between_slow_looks == 0) look_slowly();
        control_.sweep();
    } catch (const std::exception& error) {
        metrics_.count("lastflat_store_failures_total");
        log_event("store_failed", {{"why", error.what()}});
    }
}

void Housekeeping::look_slowly() {
    metrics_.set("lastflat_stored_bytes", static_cast<double>(blobs_.bytes()));
    metrics_.set("lastflat_disk_free_bytes", static_cast<double>(blobs_.free_bytes()));
}

}  // namespace lastflat::server
