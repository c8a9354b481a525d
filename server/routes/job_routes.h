// Jobs: making, watching, listing, ending.
#pragma once

#include "server/http/http.h"
#include "server/routes/service.h"

namespace lastflat::server {

/// `service` must outlive the routes.
[[nodiscard]] std::vector<http::Route> job_routes(Service& service);

}  // namespace lastflat::server
