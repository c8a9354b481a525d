// What is said of a model that was looked at.
#pragma once

#include <string>

namespace lastflat {
struct Inspection;
}

namespace lastflat::api {

/// The body of POST /v1/validate. `indent`: for people; -1: none.
[[nodiscard]] std::string to_json(const Inspection& found, int indent = -1);

}  // namespace lastflat::api
