// A job as it happens: server-sent events (WHATWG HTML, 9.2).
#pragma once

#include "server/http/http.h"
#include "server/routes/service.h"

namespace lastflat::server {

/// GET /v1/jobs/{id}/events. Events: `state` for every state the job has had since the one that
/// `Last-Event-ID` names, `progress`, `log` for what a finished job has to say (what was mended in
/// the model, warnings), `done` with the job, `shutdown` when the service ends. `service` must
/// outlive the route.
[[nodiscard]] http::Route event_route(Service& service);

}  // namespace lastflat::server
