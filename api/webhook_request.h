// Where a client wants to be told that a job has ended.
#pragma once

#include <string>
#include <string_view>

namespace lastflat::api {

struct Field;

struct WebhookRequest {
    std::string url;     ///< text; whether it is an address is not looked at
    std::string events;  ///< names with a space between; all if none were given
    std::string secret;  ///< "whsec_" and base64 of 24 to 64 bytes; empty: none was asked for
};

inline constexpr std::string_view secret_prefix = "whsec_";

enum class WebhookScope {
    jobs,  ///< every job of the client: the service makes the secret
    job    ///< one: the client brings it
};

/// Reads {"url": ..., "events": [...]} and, for one job, "secret".
/// Throws: InvalidRequest naming the field.
[[nodiscard]] WebhookRequest read_webhook(const Field& field, WebhookScope scope);

}  // namespace lastflat::api
