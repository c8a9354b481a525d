// One job, from its input to every format of its result.
#pragma once

#include "server/jobs/job.h"

namespace lastflat::server {

/// Never throws: an error of core becomes the outcome's problem; a cancelled job has neither output
/// nor problem.
[[nodiscard]] JobOutcome run_job(const JobInput& input, Progress& progress);

/// All formats of a result.
[[nodiscard]] std::shared_ptr<const JobOutput> render(const FlattenResult& result);

}  // namespace lastflat::server
