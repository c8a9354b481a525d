// One job, from its input to every format of its result.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "api/problem.h"
#include "core/flatten.h"

namespace lastflat::server {

struct JobInput {
    std::string model;
    FlattenOptions options;
};

enum class Compression { none, gzip };

struct Rendered {
    std::string bytes;
    std::string gzip;  ///< the same, compressed; empty unless asked for
};

/// A result in every format that it can be asked for.
struct JobOutput {
    Rendered json, svg, glb, obj;
    Rendered metrics;  ///< the JSON without coordinates
};

/// Exactly one of the two, or neither: it was cancelled.
struct RunOutcome {
    std::unique_ptr<const JobOutput> output;
    std::optional<api::Problem> error;
};

/// Never throws: an error of core becomes the outcome's problem.
[[nodiscard]] RunOutcome run_job(const JobInput& input, Compression compression,
                                 Progress& progress);

}  // namespace lastflat::server
