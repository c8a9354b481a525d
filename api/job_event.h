// What the events of a job's stream say (their `data`).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "api/job.h"

namespace lastflat::api {

/// Of the event `state`.
struct StateEvent {
    JobState state;
    std::int64_t at_ms;  ///< since 1970
    int attempt;
};
[[nodiscard]] std::string to_json(const StateEvent& event);

/// Of the event `progress`.
struct ProgressEvent {
    std::string stage;
    int percent;
};
[[nodiscard]] std::string to_json(const ProgressEvent& event);

/// Of the events `log`: what a result says of the model and of itself. `metrics`: as
/// `metrics_json` wrote it.
[[nodiscard]] std::vector<std::string> log_events(std::string_view metrics);
/// Of the event `log` instead, if the result cannot be given.
[[nodiscard]] std::string log_event(const Problem& problem);

}  // namespace lastflat::api
