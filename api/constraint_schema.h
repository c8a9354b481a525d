// The schema of the constraint JSON as a document of its own.
#pragma once

#include <string>
#include <string_view>

namespace lastflat::api {

/// In: `openapi.json`.
[[nodiscard]] std::string constraint_schema(std::string_view contract);

}  // namespace lastflat::api
