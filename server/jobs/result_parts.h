// A result's blob: its table of contents, and reading parts of it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "server/jobs/blob_store.h"
#include "server/jobs/job.h"

namespace lastflat::server {

/// The table of contents as JSON.
[[nodiscard]] std::string to_json(const std::vector<ResultPart>& parts);

/// Of all parts together.
[[nodiscard]] std::uint64_t size_of(const std::vector<ResultPart>& parts);

/// Empty text: no parts. Throws: nlohmann::json::exception.
[[nodiscard]] std::vector<ResultPart> result_parts_of(std::string_view text);

/// Throws: CorruptBlob if there is no such part.
[[nodiscard]] const ResultPart& result_part(const JobRecord& job, std::string_view format);
/// The bytes of one part of a job's result, checked against its digest.
/// Throws: StoreError; CorruptBlob.
[[nodiscard]] std::string result_bytes(const BlobStore& blobs, const JobRecord& job,
                                       const ResultPart& part);

}  // namespace lastflat::server
