// Many jobs in one request: one last after the other, or one last under many constraints.
#pragma once

#include "server/http/http.h"
#include "server/jobs/job_intake.h"
#include "server/routes/job_view.h"

namespace lastflat::server {

/// What these routes work with; all must outlive them.
struct BatchServices {
    JobIntake& intake;
    JobStore& jobs;
    const JobView& view;
};

/// POST /v1/jobs:batch and GET /v1/batches/{id}.
[[nodiscard]] std::vector<http::Route> batch_routes(const BatchServices& service);

}  // namespace lastflat::server
