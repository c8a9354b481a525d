// Jobs: watching, ending.
#pragma once

#include "server/jobs/job_control.h"
#include "server/routes/job_wait.h"

namespace lastflat::server {

/// What these routes work with; all must outlive them.
struct JobServices {
    JobStore& jobs;
    JobControl& control;
    const JobView& view;
    const JobWait& wait;
};

/// GET and DELETE /v1/jobs/{id}, POST /v1/jobs/{id}/cancel.
[[nodiscard]] std::vector<http::Route> job_routes(const JobServices& service);

}  // namespace lastflat::server
