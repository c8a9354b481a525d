// The endpoints, as plain functions from request to response.
#pragma once

#include "server/http/http.h"
#include "server/jobs/worker_pool.h"
#include "server/stores/job_store.h"

namespace lastflat::server {

/// Every route of the service. `store` and `workers` must outlive the routes.
[[nodiscard]] std::vector<http::Route> job_routes(JobStore& store, WorkerPool& workers);

/// A problem document as a response; 503 and 429 carry Retry-After.
[[nodiscard]] http::Response problem_response(const api::Problem& problem);

}  // namespace lastflat::server
