// What the routes work with.
#pragma once

#include <atomic>
#include <map>
#include <mutex>
#include <set>
#include <string>

#include "server/cli/settings.h"
#include "server/jobs/asset_store.h"
#include "server/jobs/estimate.h"
#include "server/jobs/job_store.h"
#include "server/jobs/job_watch.h"
#include "server/jobs/key_store.h"
#include "server/runner/runners.h"
#include "server/runner/worker_pool.h"
#include "server/storage/blob_store.h"
#include "server/support/metrics.h"

namespace lastflat::server {

/// Idempotency keys of requests that are being taken right now.
class KeysInFlight {
public:
    [[nodiscard]] bool enter(const std::string& key) {
        const std::scoped_lock lock(mutex_);
        return keys_.insert(key).second;
    }
    void leave(const std::string& key) {
        const std::scoped_lock lock(mutex_);
        keys_.erase(key);
    }

private:
    std::mutex mutex_;
    std::set<std::string> keys_;
};

/// How many places to wait in each key has.
class PlacesByKey {
public:
    /// False: the key has as many as it may. Without keys, whoever asks may have all.
    [[nodiscard]] bool enter(const std::string& key, std::size_t most) {
        const std::scoped_lock lock(mutex_);
        std::size_t& places = places_[key];
        if (!key.empty() && places >= most) return false;
        ++places;
        return true;
    }
    void leave(const std::string& key) {
        const std::scoped_lock lock(mutex_);
        if (--places_[key] == 0) places_.erase(key);
    }

private:
    std::mutex mutex_;
    std::map<std::string, std::size_t> places_;
};

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
    Inquiry inquire;
    std::string cursor_secret;
    KeysInFlight keys_in_flight{};
    PlacesByKey places{};
    std::atomic<bool> draining{false};
};

}  // namespace lastflat::server
