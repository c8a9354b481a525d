// One attempt to deliver a message.
#pragma once

#include <string>

#include "server/jobs/webhook_store.h"

namespace lastflat::server {

struct PostOutcome {
    int status = 0;     ///< 0: there was no answer
    std::string error;  ///< why, if it was not delivered
    [[nodiscard]] bool delivered() const { return status >= 200 && status < 300; }
};

/// Signed as Standard Webhooks 1.0.0 ask: webhook-id, webhook-timestamp, webhook-signature.
/// Redirects are not followed; 10 s at most; the answer's body is not read. An address that is not
/// public is refused when the connection is made, whatever name led there, unless `anywhere`.
[[nodiscard]] PostOutcome post_message(const DueDelivery& due, bool anywhere);

/// "v1,BASE64" of a message.
[[nodiscard]] std::string signature(const std::string& secret, const std::string& id,
                                    std::int64_t timestamp, const std::string& payload);

/// Whether a webhook may have this target: http or https, a host, no user name.
[[nodiscard]] bool is_webhook_url(const std::string& url);
inline constexpr char not_a_webhook_url[] = "must be an http or https address without a user name";

}  // namespace lastflat::server
