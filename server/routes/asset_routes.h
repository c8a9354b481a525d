// Models kept for many jobs, and the validation of a model without a job.
#pragma once

#include "server/http/http.h"
#include "server/routes/service.h"

namespace lastflat::server {

/// `service` must outlive the routes.
[[nodiscard]] std::vector<http::Route> asset_routes(Service& service);

}  // namespace lastflat::server
