// Where a client wants to be told that a job has ended, and what it is told.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "api/job.h"

namespace lastflat::api {

struct Field;

/// A client is told of a job's end, in these states.
inline constexpr Word<JobState> webhook_events[] = {{"job.succeeded", JobState::succeeded},
                                                    {"job.failed", JobState::failed},
                                                    {"job.canceled", JobState::canceled}};

/// The names with a space between, and back; what is no name is left out.
[[nodiscard]] std::string event_names(const std::vector<JobState>& events);
[[nodiscard]] std::vector<JobState> named_events(std::string_view names);

struct WebhookRequest {
    std::string url;  ///< text; whether it is an address is not looked at
    std::vector<JobState> events;
    std::string secret;  ///< "whsec_" and base64 of 24 to 64 bytes; empty: none was asked for
};

inline constexpr std::string_view secret_prefix = "whsec_";

enum class WebhookScope {
    jobs,  ///< every job of the client: the service makes the secret
    job    ///< one: the client brings it
};

/// Reads {"url": ..., "events": [...]} and, for one job, "secret". Without events: all of them.
/// Throws: InvalidRequest naming the field.
[[nodiscard]] WebhookRequest read_webhook(const Field& field, WebhookScope scope);
/// The body of POST /v1/webhooks. Throws as above.
[[nodiscard]] WebhookRequest webhook_from_json(std::string_view text);

struct Webhook {
    std::string id, url;
    std::string secret;  ///< "whsec_" and base64
    std::vector<JobState> events;
    std::int64_t created_ms = 0;  ///< since 1970
};
/// `with_secret`: only in the answer that makes it.
[[nodiscard]] std::string to_json(const Webhook& webhook, bool with_secret);
[[nodiscard]] std::string to_json(const std::vector<Webhook>& webhooks);

struct JobEnded {
    std::string id;
    JobState state;
    std::string tag;  ///< empty: none
};
struct WebhookTest {
    std::string webhook;
};
struct WebhookMessage {
    std::int64_t at_ms;  ///< since 1970
    std::variant<JobEnded, WebhookTest> data;
};
/// "job.failed", "test".
[[nodiscard]] std::string type_of(const WebhookMessage& message);
[[nodiscard]] std::string to_json(const WebhookMessage& message);

struct Delivery {
    std::string id;  ///< the same for every attempt
    std::string event;
    std::string payload;  ///< a `WebhookMessage`, as it is sent
    std::int64_t created_ms = 0;
    int attempt = 0;
    std::optional<std::int64_t> next_ms;  ///< of the next attempt; nothing: there is none
    bool delivered = false;
    int status = 0;  ///< of the last answer; 0: there was none
    std::string error;
};
[[nodiscard]] std::string to_json(const std::vector<Delivery>& deliveries);

}  // namespace lastflat::api
