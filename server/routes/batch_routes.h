// Many jobs in one request: one last after the other, or one last under many constraints.
#pragma once

#include "server/http/http.h"
#include "server/routes/service.h"

namespace lastflat::server {

/// POST /v1/jobs:batch and GET /v1/batches/{id}. `service` must outlive the routes.
[[nodiscard]] std::vector<http::Route> batch_routes(Service& service);

}  // namespace lastflat::server
