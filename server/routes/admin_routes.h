// Health, readiness and metrics: for those who operate the service.
#pragma once

#include <atomic>
#include <functional>

#include "server/http/http.h"
#include "server/jobs/job_store.h"
#include "server/support/metrics.h"

namespace lastflat::server {

/// What these routes work with; all must outlive them.
struct AdminServices {
    JobStore& jobs;
    Metrics& metrics;
    const std::atomic<bool>& draining;
    std::size_t workers = 1;
    std::function<std::size_t()> busy_workers;
    std::function<void()> check_storage;  ///< writes and reads; throws StoreError
};

/// GET /healthz: answered even when every connection is taken.
[[nodiscard]] http::Route health_route(const AdminServices& service);

/// /healthz, /readyz, /metrics and /version, for a listener of their own.
[[nodiscard]] std::vector<http::Route> admin_routes(const AdminServices& service);

}  // namespace lastflat::server
