// Results: in the format that is wanted, or their measures alone.
#pragma once

#include "server/http/http.h"
#include "server/routes/service.h"

namespace lastflat::server {

/// `service` must outlive the routes.
[[nodiscard]] std::vector<http::Route> result_routes(Service& service);

}  // namespace lastflat::server
