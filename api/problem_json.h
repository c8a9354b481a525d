// A problem as a JSON value, for documents that contain one.
#pragma once

#include <nlohmann/json.hpp>

#include "api/problem.h"

namespace lastflat::api {

[[nodiscard]] nlohmann::ordered_json problem_json(const Problem& problem);

}  // namespace lastflat::api
