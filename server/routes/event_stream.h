// A job as it happens: server-sent events (WHATWG HTML, 9.2).
#pragma once

#include "server/jobs/blob_store.h"
#include "server/jobs/job_store.h"
#include "server/routes/job_view.h"
#include "server/routes/waiting_seat.h"

namespace lastflat::server {

/// What the route works with; all must outlive it.
struct EventServices {
    JobStore& jobs;
    const BlobStore& blobs;
    JobWatch& watch;
    const JobView& view;
    SeatsByKey& seats;
};

/// GET /v1/jobs/{id}/events. Events: `state` for every state the job has had since the one that
/// `Last-Event-ID` names, `progress`, `log` for what a finished job has to say (what was mended in
/// the model, warnings), `done` with the job, `shutdown` when the service ends.
[[nodiscard]] http::Route event_route(const EventServices& service);

}  // namespace lastflat::server
