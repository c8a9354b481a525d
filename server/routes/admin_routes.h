// Health, readiness and metrics: for those who operate the service.
#pragma once

#include "server/http/http.h"
#include "server/routes/service.h"

namespace lastflat::server {

/// GET /healthz: answered even when every connection is taken.
[[nodiscard]] http::Route health_route(Service& service);

/// /healthz, /readyz, /metrics and /version, for a listener of their own.
/// `service` must outlive the routes.
[[nodiscard]] std::vector<http::Route> admin_routes(Service& service);

}  // namespace lastflat::server
