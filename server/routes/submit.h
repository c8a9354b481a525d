// From a submission to a job on the disk.
#pragma once

#include "server/routes/service.h"
#include "server/routes/submission.h"

namespace lastflat::server {

struct Submitted {
    JobRecord job;
    bool repeated = false;  ///< it was there already, the same
};

/// Throws: Refusal (507) if the disk has less room than the operator wants to keep; StoreError.
void check_room(const Service& service);

/// Keeps a job; on the disk when this returns. `id`: chosen by the client, else empty.
/// Throws: Refusal (409, 422, 429, 503, 507), StoreError.
[[nodiscard]] Submitted submit(Service& service, const http::Request& request,
                               const Submission& submission, const std::string& id,
                               const std::string& batch);

}  // namespace lastflat::server
