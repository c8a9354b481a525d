// A result on the disk: every format, plain and compressed, one after the other in one file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "server/jobs/job.h"
#include "server/worker/run_job.h"

namespace lastflat::server {

struct ResultPack {
    std::string digest;  ///< SHA-256 of the file
    std::vector<ResultPart> parts;
};

/// Writes the file; it is on the disk when the call returns. Throws: StoreError.
[[nodiscard]] ResultPack write_result_pack(const JobOutput& output,
                                           const std::filesystem::path& file);

/// gzip (RFC 1952) without a time stamp: the same bytes give the same bytes.
[[nodiscard]] std::string gzip(std::string_view bytes);

}  // namespace lastflat::server
