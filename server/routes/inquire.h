// Questions that a worker process answers while the client waits.
#pragma once

#include "server/http/http.h"
#include "server/routes/service.h"

namespace lastflat::server {

/// The report of a validation or a mapping, or its problem. Takes a place to wait.
/// Throws: Refusal (422, 500, 503).
[[nodiscard]] http::Response inquire(Service& service, const http::Request& request, Task task,
                                     const std::string& model, const std::string& text);

}  // namespace lastflat::server
