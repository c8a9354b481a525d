// A job, as it stands on the wire.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "api/problem.h"

namespace lastflat::api {

struct Job {
    std::string id;
    std::string state;  ///< queued, running, canceling, succeeded, failed, canceled
    std::string tag;
    std::int64_t created_ms = 0;  ///< since 1970
    std::optional<std::int64_t> started_ms, finished_ms;
    std::string stage;  ///< of the flattening, while it runs
    int percent = 0;
    std::optional<std::size_t> queue_position;  ///< 1: next
    std::optional<Problem> error;               ///< of a failed job
};

/// The body of GET /v1/jobs/{id}. Times are RFC 3339 in UTC.
[[nodiscard]] std::string to_json(const Job& job);

/// "2024-02-29T23:59:59.123Z".
[[nodiscard]] std::string rfc3339(std::int64_t milliseconds);

}  // namespace lastflat::api
