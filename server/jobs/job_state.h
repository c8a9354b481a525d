// The life of a job.
#pragma once

#include <string_view>

#include "api/job.h"

namespace lastflat::server {

/// queued ──► running ──► succeeded
///   │  ◄───────┤  │
///   │          ├──┴────► failed
///   │          ▼
///   │       canceling ─► canceled
///   ├──────────────────► canceled
///   └──────────────────► succeeded, with the result of an earlier job that asked the same
///
/// A running job goes back to queued when its worker is lost or the service ends.
using api::is_final;
using api::JobState;

[[nodiscard]] constexpr std::string_view name(JobState state) {
    return api::word_of(api::job_states, state);
}

/// Whether a job may go from one state to the other. Stores ask it on every change.
[[nodiscard]] constexpr bool may_become(JobState from, JobState to) {
    switch (from) {
        case JobState::queued:
            return to == JobState::running || to == JobState::canceled || to == JobState::succeeded;
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
