// The validation of a model and its request.
#pragma once

#include <nlohmann/json.hpp>

#include "server/worker/run_job.h"

namespace lastflat::server {

/// {"report": {...}}, or {"problem": {...}} if there is no surface to speak of. Never throws what
/// `run_job` would not.
[[nodiscard]] nlohmann::ordered_json inspect_job(const JobInput& input);

}  // namespace lastflat::server
