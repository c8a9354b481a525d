// The life of a job.
#pragma once

#include <optional>
#include <string_view>

namespace lastflat::server {

/// queued ──► running ──► succeeded
///   │  ◄───────┤  │
///   │          ├──┴────► failed
///   │          ▼
///   │       canceling ─► canceled
///   └──────────────────► canceled
///
/// A running job goes back to queued when its worker is lost or the service ends.
enum class JobState { queued, running, canceling, succeeded, failed, canceled };

[[nodiscard]] constexpr std::string_view name(JobState state) {
    switch (state) {
        case JobState::queued: return "queued";
        case JobState::running: return "running";
        case JobState::canceling: return "canceling";
        case JobState::succeeded: return "succeeded";
        case JobState::failed: return "failed";
        case JobState::canceled: return "canceled";
    }
    return "unknown";
}

[[nodiscard]] constexpr std::optional<JobState> job_state_of(std::string_view word) {
    for (const JobState state : {JobState::queued, JobState::running, JobState::canceling,
                                 JobState::succeeded, JobState::failed, JobState::canceled}) {
        if (name(state) == word) return state;
    }
    return std::nullopt;
}

[[nodiscard]] constexpr bool is_final(JobState state) {
    return state == JobState::succeeded || state == JobState::failed || state == JobState::canceled;
}

/// Whether a job may go from one state to the other. Stores ask it on every change.
[[nodiscard]] constexpr bool may_become(JobState from, JobState to) {
    switch (from) {
        case JobState::queued: return to == JobState::running || to == JobState::canceled;
        case JobState::running:
            return to == JobState::succeeded || to == JobState::failed ||
                   to == JobState::canceling || to == JobState::queued;
        case JobState::canceling: return to == JobState::canceled;
        case JobState::succeeded:
        case JobState::failed:
        case JobState::canceled: return false;
    }
    return false;
}

}  // namespace lastflat::server
