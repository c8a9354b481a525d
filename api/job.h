// A job, as it stands on the wire.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/problem.h"
#include "api/words.h"

namespace lastflat::api {

enum class JobState { queued, running, canceling, succeeded, failed, canceled };
inline constexpr Word<JobState> job_states[] = {
    {"queued", JobState::queued},       {"running", JobState::running},
    {"canceling", JobState::canceling}, {"succeeded", JobState::succeeded},
    {"failed", JobState::failed},       {"canceled", JobState::canceled}};

/// The order of one client's own jobs: those that somebody waits for come first.
enum class JobPriority { batch, interactive };
inline constexpr Word<JobPriority> job_priorities[] = {{"interactive", JobPriority::interactive},
                                                       {"batch", JobPriority::batch}};

[[nodiscard]] constexpr bool is_final(JobState state) {
    return state == JobState::succeeded || state == JobState::failed || state == JobState::canceled;
}

struct Job {
    std::string id;
    JobState state = JobState::queued;
    std::string reason;  ///< why it was canceled: client, deadline
    std::string tag, batch;
    JobPriority priority = JobPriority::interactive;
    std::int64_t created_ms = 0;  ///< since 1970
    std::optional<std::int64_t> started_ms, finished_ms, cancel_at_ms;
    std::optional<std::int64_t> result_expires_ms, expires_ms;
    int attempt = 0;      ///< how many times it was begun
    bool cached = false;  ///< answered by the result of an earlier job that asked the same
    std::string stage;    ///< of the flattening, while it runs; empty: its state
    int percent = 0;
    std::optional<double> remaining_s;          ///< about, from jobs like it
    std::optional<std::size_t> queue_position;  ///< 1: next
    std::optional<double> queue_s;              ///< until it begins, about
    std::optional<Problem> error;               ///< of a failed job
};

/// The body of GET /v1/jobs/{id}.
[[nodiscard]] std::string to_json(const Job& job);

/// With the job's result, a JSON document, as its last member.
[[nodiscard]] std::string to_json(const Job& job, std::string_view result);

struct JobList {
    std::vector<Job> items;
    std::string next_cursor;  ///< empty: this is the end of the list
};
[[nodiscard]] std::string to_json(const JobList& list);

}  // namespace lastflat::api
