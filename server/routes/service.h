// What the routes work with.
#pragma once

#include <atomic>

#include "server/jobs/estimate.h"
#include "server/jobs/job_watch.h"
#include "server/jobs/runners.h"
#include "server/jobs/worker_pool.h"
#include "server/observe/metrics.h"
#include "server/settings.h"
#include "server/stores/asset_store.h"
#include "server/stores/blob_store.h"
#include "server/stores/job_store.h"
#include "server/stores/key_store.h"

namespace lastflat::server {

struct Service {
    const Settings& settings;
    JobStore& jobs;
    AssetStore& assets;
    KeyStore& keys;
    BlobStore& blobs;
    JobWatch& watch;
    WorkerPool& workers;
    Estimate& estimate;
    Metrics& metrics;
    Validator validate;
    std::string cursor_secret;
    std::atomic<bool> draining{false};
};

}  // namespace lastflat::server
