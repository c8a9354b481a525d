// Results: in the format that is wanted, or their measures alone.
#pragma once

#include "server/jobs/blob_store.h"
#include "server/jobs/job_store.h"
#include "server/routes/task_answer.h"
#include "server/runner/resident_maps.h"

namespace lastflat::server {

/// What these routes work with; all must outlive them.
struct ResultServices {
    JobStore& jobs;
    const BlobStore& blobs;
    const TaskAnswers& tasks;
    ResidentMaps& maps;
    SeatsByKey& seats;
};

[[nodiscard]] std::vector<http::Route> result_routes(const ResultServices& service);

}  // namespace lastflat::server
