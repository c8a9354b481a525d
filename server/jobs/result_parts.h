// The table of contents of a result's blob, as JSON.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "server/jobs/job.h"

namespace lastflat::server {

[[nodiscard]] std::string to_json(const std::vector<ResultPart>& parts);

/// Empty text: no parts. Throws: nlohmann::json::exception.
[[nodiscard]] std::vector<ResultPart> result_parts_of(std::string_view text);

}  // namespace lastflat::server
