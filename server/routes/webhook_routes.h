// Webhooks: who wants to be told, and what was sent.
#pragma once

#include "server/cli/settings.h"
#include "server/http/http.h"
#include "server/jobs/webhook_store.h"

namespace lastflat::server {

/// Throws: Refusal (403) if the service sends no webhooks.
void require_webhooks(const Settings& settings);

/// Both must outlive the routes.
[[nodiscard]] std::vector<http::Route> webhook_routes(WebhookStore& webhooks,
                                                      const Settings& settings);

}  // namespace lastflat::server
