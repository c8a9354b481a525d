// Repairs as they stand in results and reports.
#pragma once

#include <nlohmann/json.hpp>

#include "api/flatten_result.h"

namespace lastflat::api {

[[nodiscard]] nlohmann::ordered_json repairs_json(const std::vector<RepairResult>& repairs);

}  // namespace lastflat::api
