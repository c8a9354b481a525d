// The one table from core's errors to the wire's problems.
#pragma once

#include "api/object_reader.h"
#include "api/problem.h"
#include "core/error.h"

namespace lastflat::server {

[[nodiscard]] api::Problem problem_of(const Error& error);
[[nodiscard]] api::Problem problem_of(const api::InvalidRequest& error);

/// A job that needs more memory than it may have.
[[nodiscard]] api::Problem out_of_memory();

/// Whether the caller can mend it (the command line's exit code 2), or the program is at fault.
[[nodiscard]] inline bool is_bad_input(const api::Problem& problem) {
    return problem.status < 500;
}

}  // namespace lastflat::server
