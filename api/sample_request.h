// The request that goes with the sample last.
#pragma once

#include <string>

namespace lastflat {
struct SampleLast;
}

namespace lastflat::api {

[[nodiscard]] std::string sample_request(const SampleLast& last);

}  // namespace lastflat::api
