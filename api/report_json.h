// Repairs and findings as they stand in results and reports.
#pragma once

#include <nlohmann/json.hpp>

#include "api/flatten_result.h"

namespace lastflat::api {

[[nodiscard]] nlohmann::ordered_json repairs_json(const std::vector<RepairResult>& repairs);

/// With a `request` that says of curves, cuts, regions and locks what was found.
[[nodiscard]] nlohmann::ordered_json found_json(const FoundLandmarks& found);

}  // namespace lastflat::api
