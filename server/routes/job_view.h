// A job as its clients see it.
#pragma once

#include "server/routes/service.h"

namespace lastflat::server {

/// The job; a 404 or 410 refusal if the principal has none of that id.
[[nodiscard]] JobRecord found_job(const Service& service, const std::string& owner,
                                  const std::string& id);

[[nodiscard]] std::string job_json(const Service& service, const JobRecord& job);

/// Changes with every change of state and every step of the progress.
[[nodiscard]] std::string job_etag(const Service& service, const JobRecord& job);

/// The plain bytes of one part of a job's result, checked against its digest.
/// Throws: Refusal if there is no such part; StoreError; CorruptBlob.
[[nodiscard]] std::string result_bytes(const Service& service, const JobRecord& job,
                                       const ResultPart& part);
[[nodiscard]] const ResultPart& result_part(const JobRecord& job, std::string_view format,
                                            bool gzip);

}  // namespace lastflat::server
