// Webhooks: who wants to be told, and what was sent.
#pragma once

#include "server/http/http.h"
#include "server/jobs/webhook_store.h"

namespace lastflat::server {

/// `webhooks` must outlive the routes. `sends`: whether the service sends any.
[[nodiscard]] std::vector<http::Route> webhook_routes(WebhookStore& webhooks, bool sends);

}  // namespace lastflat::server
