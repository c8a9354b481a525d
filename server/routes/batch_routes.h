// Many jobs in one request: one last after the other, or one last under many constraints.
#pragma once

#include "server/http/http.h"
#include "server/jobs/job_control.h"
#include "server/jobs/job_intake.h"
#include "server/routes/batch_view.h"

namespace lastflat::server {

/// What these routes work with; all must outlive them.
struct BatchServices {
    JobIntake& intake;
    JobControl& control;
    const BatchView& view;
};

/// POST /v1/jobs:batch, GET /v1/batches/{id}, POST /v1/batches/{id}/cancel.
[[nodiscard]] std::vector<http::Route> batch_routes(const BatchServices& service);

}  // namespace lastflat::server
