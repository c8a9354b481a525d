// A request as JSON, in the words in which it may be sent.
#pragma once

#include <nlohmann/json.hpp>

#include "core/request.h"

namespace lastflat::api {

/// What is as by default is left out; `flatten_request_from_json` reads the same request from it.
[[nodiscard]] nlohmann::ordered_json request_json(const Request& request);

}  // namespace lastflat::api
