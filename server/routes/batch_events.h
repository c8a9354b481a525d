// A batch as it happens: server-sent events.
#pragma once

#include "server/http/http.h"
#include "server/routes/batch_view.h"

namespace lastflat::server {

/// What the route works with; all must outlive it.
struct BatchEventServices {
    const BatchView& view;
    const JobWatch& watch;
    SeatsByKey& seats;
};

/// GET /v1/batches/{id}/events. Events: `job` with each job whose state is another than the client
/// has seen (at first, every job), `done` with the batch, `deleted` when none of its jobs is left,
/// `shutdown` when the service ends.
[[nodiscard]] http::Route batch_event_route(const BatchEventServices& service);

}  // namespace lastflat::server
