// The jobs of a key, page by page.
#pragma once

#include "server/http/http.h"
#include "server/jobs/job_store.h"
#include "server/routes/job_view.h"

namespace lastflat::server {

/// GET /v1/jobs. `secret`: signs the cursors. The others must outlive the route.
[[nodiscard]] http::Route job_list_route(JobStore& jobs, const JobView& view,
                                         const std::string& secret);

}  // namespace lastflat::server
