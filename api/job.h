// A job, as it stands on the wire.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace lastflat::api {

struct Job {
    std::string id;
    std::string state;   ///< queued, running, canceling, succeeded, failed, canceled
    std::string reason;  ///< why it was canceled: client, deadline
    std::string tag, batch;
    std::int64_t created_ms = 0;  ///< since 1970
    std::optional<std::int64_t> started_ms, finished_ms, cancel_at_ms;
    std::optional<std::int64_t> result_expires_ms, expires_ms;
    int attempt = 0;    ///< how many times it was begun
    std::string stage;  ///< of the flattening, while it runs
    int percent = 0;
    std::optional<double> remaining_s;          ///< about, from jobs like it
    std::optional<std::size_t> queue_position;  ///< 1: next
    std::optional<double> queue_s;              ///< until it begins, about
    std::string error;                          ///< of a failed job: its problem, JSON
};

/// The body of GET /v1/jobs/{id}. Times are RFC 3339 in UTC.
[[nodiscard]] std::string to_json(const Job& job);

/// "2024-02-29T23:59:59.123Z".
[[nodiscard]] std::string rfc3339(std::int64_t milliseconds);

/// The inverse, for whole seconds or fractions of them, in UTC; nothing if it is no such time.
[[nodiscard]] std::optional<std::int64_t> rfc3339_ms(const std::string& text);

}  // namespace lastflat::api
