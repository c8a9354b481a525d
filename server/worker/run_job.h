// One job, from its input to every format of its result.
#pragma once

#include <string>

#include "core/flatten.h"
#include "server/protocol/result_pack.h"

namespace lastflat::server {

struct JobInput {
    std::string model;
    FlattenOptions options;
};

[[nodiscard]] JobOutput render(const FlattenResult& result);

/// Throws: Error.
[[nodiscard]] JobOutput run_job(const JobInput& input, Progress& progress);

}  // namespace lastflat::server
