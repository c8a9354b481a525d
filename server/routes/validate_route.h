// What a model is and what is wrong with it, without a job.
#pragma once

#include <atomic>

#include "server/jobs/asset_store.h"
#include "server/jobs/blob_store.h"
#include "server/routes/task_answer.h"

namespace lastflat::server {

/// What the route works with; all must outlive it.
struct ValidateServices {
    AssetStore& assets;
    const BlobStore& blobs;
    const TaskAnswers& tasks;
    const std::atomic<bool>& draining;
};

/// POST /v1/validate.
[[nodiscard]] http::Route validate_route(const ValidateServices& service);

}  // namespace lastflat::server
