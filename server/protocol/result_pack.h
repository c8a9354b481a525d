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

}  // namespace lastflat::server
