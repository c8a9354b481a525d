// Sending jobs.
#pragma once

#include "server/jobs/job_intake.h"
#include "server/routes/job_wait.h"

namespace lastflat::server {

/// What these routes work with; all must outlive them.
struct SubmitServices {
    JobIntake& intake;
    const BlobStore& blobs;
    const JobView& view;
    const JobWait& wait;
};

/// POST /v1/jobs and PUT /v1/jobs/{id}.
[[nodiscard]] std::vector<http::Route> submit_routes(const SubmitServices& service);

}  // namespace lastflat::server
