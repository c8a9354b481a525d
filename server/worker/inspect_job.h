// What a model is, and whether its request can be met.
#pragma once

#include <nlohmann/json.hpp>

#include "server/worker/run_job.h"

namespace lastflat::server {

/// {"report": {...}}, or {"problem": {...}} if there is no surface to speak of. Never throws what
/// `run_job` would not.
[[nodiscard]] nlohmann::ordered_json inspect_job(const JobInput& input);

}  // namespace lastflat::server
