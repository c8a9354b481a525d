// Points and lines from the last to its pattern and back.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace lastflat::server {

/// `flat_obj`: the pieces, as a result's OBJ; `request`: see `api::MapRequest`.
/// {"report": {...}}, or {"problem": {...}}. Never throws what `run_job` would not.
[[nodiscard]] nlohmann::ordered_json map_job(const std::string& flat_obj,
                                             const std::string& request);

}  // namespace lastflat::server
