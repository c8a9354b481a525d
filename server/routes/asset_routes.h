// Models kept for many jobs.
#pragma once

#include "server/http/http.h"
#include "server/jobs/asset_store.h"
#include "server/jobs/blob_store.h"
#include "server/jobs/job_store.h"

namespace lastflat::server {

/// What these routes work with; all must outlive them.
struct AssetServices {
    AssetStore& assets;
    const BlobStore& blobs;
    JobStore& jobs;
    std::size_t assets_per_key_mb = 4096, storage_per_key_mb = 16384;
    std::size_t min_free_mb = 512;  ///< of the disk
};

[[nodiscard]] std::vector<http::Route> asset_routes(const AssetServices& service);

}  // namespace lastflat::server
