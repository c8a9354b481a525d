// What all jobs of a batch came to: one table, one archive.
#pragma once

#include "server/http/http.h"
#include "server/jobs/blob_store.h"
#include "server/routes/batch_view.h"

namespace lastflat::server {

/// What these routes work with; all must outlive them.
struct BatchResultServices {
    const BatchView& view;
    const BlobStore& blobs;
};

/// GET /v1/batches/{id}/results.csv and /result.zip: 409 until every job has ended.
[[nodiscard]] std::vector<http::Route> batch_result_routes(const BatchResultServices& service);

}  // namespace lastflat::server
