// A task that a worker does while the client waits: an inspection, a mapping, a picture.
#pragma once

#include "server/http/http.h"
#include "server/routes/waiting_seat.h"
#include "server/runner/in_worker.h"

namespace lastflat::server {

class TaskAnswers {
public:
    /// `seats` must outlive it.
    TaskAnswers(SeatsByKey& seats, RunTask run) : seats_(seats), run_(std::move(run)) {}

    /// What the task reports. Takes a seat to wait in.
    /// Throws: api::Refusal (422, 500, 503): the task's problem among them.
    [[nodiscard]] std::string report(const http::Request& request, Task task,
                                     std::string_view model, std::string_view text) const;

private:
    SeatsByKey& seats_;
    const RunTask run_;
};

}  // namespace lastflat::server
