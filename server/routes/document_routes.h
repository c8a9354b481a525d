// What the service says of itself: its contract, for programs and for people.
#pragma once

#include <vector>

#include "server/http/http.h"

namespace lastflat::server {

/// /openapi.json, /schemas/constraints.json and /docs.
[[nodiscard]] std::vector<http::Route> document_routes();

}  // namespace lastflat::server
