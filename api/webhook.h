// Where a client wants to be told that a job has ended, and what it is told.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "api/job.h"

namespace lastflat::api {

struct Field;

/// A client is told of the end of a job, in each of its states, and of a batch.
enum class WebhookEvent { job_succeeded, job_failed, job_canceled, batch_finished };
inline constexpr Word<WebhookEvent> job_events[] = {{"job.succeeded", WebhookEvent::job_succeeded},
                                                    {"job.failed", WebhookEvent::job_failed},
                                                    {"job.canceled", WebhookEvent::job_canceled}};
inline constexpr Word<WebhookEvent> webhook_events[] = {
    job_events[0], job_events[1], job_events[2], {"batch.finished", WebhookEvent::batch_finished}};

/// The names with a space between, and back; what is no name is left out.
[[nodiscard]] std::string event_names(const std::vector<WebhookEvent>& events);
[[nodiscard]] std::vector<WebhookEvent> named_events(std::string_view names);

struct WebhookRequest {
    std::string url;  ///< text; whether it is an address is not looked at
    std::vector<WebhookEvent> events;
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
    std::vector<WebhookEvent> events;
    std::int64_t created_ms = 0;  ///< since 1970
};
/// `with_secret`: only in the answer that makes it.
[[nodiscard]] std::string to_json(const Webhook& webhook, bool with_secret);
[[nodiscard]] std::string to_json(const std::vector<Webhook>& webhooks);

struct JobEnded {
    std::string id;
    JobState state;
    std::string tag, batch;  ///< empty: none
};
struct BatchFinished {
    std::string id;
    std::map<JobState, std::size_t> states;  ///< how many of its jobs ended in each
};
struct WebhookTest {
    std::string webhook;
};
struct WebhookMessage {
    std::int64_t at_ms;  ///< since 1970
    std::variant<JobEnded, BatchFinished, WebhookTest> data;
};
/// "job.failed", "batch.finished", "test".
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
