// One job, from its input to every format of its result.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "api/problem.h"
#include "core/flatten.h"
#include "server/protocol/result_pack.h"

namespace lastflat::server {

struct JobInput {
    std::string model;
    FlattenOptions options;
};

enum class Compression { none, gzip };

/// Exactly one of the two, or neither: it was canceled.
struct RunOutcome {
    std::unique_ptr<const JobOutput> output;
    std::optional<api::Problem> error;
};

/// Never throws: an error of core becomes the outcome's problem.
[[nodiscard]] RunOutcome run_job(const JobInput& input, Compression compression,
                                 Progress& progress);

}  // namespace lastflat::server
