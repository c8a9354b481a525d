// A job as the server keeps it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "api/problem.h"
#include "core/flatten.h"
#include "server/jobs/job_state.h"

namespace lastflat::server {

using Bytes = std::shared_ptr<const std::string>;

/// What a job asks for.
struct JobInput {
    Bytes model;
    FlattenOptions options;
    std::string tag;
};

/// A result in every format that it can be asked for.
struct JobOutput {
    Bytes json, svg, glb, obj;
    [[nodiscard]] std::size_t size() const {
        return json->size() + svg->size() + glb->size() + obj->size();
    }
};

struct JobRecord {
    std::string id;
    JobState state = JobState::queued;
    std::string tag;
    std::int64_t created_ms = 0;
    std::optional<std::int64_t> started_ms, finished_ms;
    std::optional<std::size_t> queue_position;  ///< while queued; 1: next
    std::optional<api::Problem> error;          ///< of a failed job
    std::shared_ptr<const JobOutput> output;    ///< of a succeeded job; null once it has expired
};

/// How a run ended. Exactly one of the two, or neither: it was cancelled.
struct JobOutcome {
    std::shared_ptr<const JobOutput> output;
    std::optional<api::Problem> error;
};

/// 26 characters that sort by time and cannot be guessed (a ULID).
[[nodiscard]] std::string new_job_id();

/// Milliseconds since 1970.
[[nodiscard]] std::int64_t now_ms();

}  // namespace lastflat::server
