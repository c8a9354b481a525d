// Live sessions: a last and its pattern, for as long as somebody changes the request.
#pragma once

#include "server/jobs/asset_store.h"
#include "server/jobs/job_intake.h"
#include "server/routes/job_view.h"
#include "server/routes/waiting_seat.h"
#include "server/runner/live_sessions.h"

namespace lastflat::server {

/// What these routes work with; all must outlive them.
struct SessionServices {
    LiveSessions& sessions;
    JobIntake& intake;
    AssetStore& assets;
    const BlobStore& blobs;
    const JobView& view;
    SeatsByKey& seats;
    std::size_t min_free_mb;  ///< of the disk
};

/// Everything under /v1/sessions.
[[nodiscard]] std::vector<http::Route> session_routes(const SessionServices& service);

}  // namespace lastflat::server
