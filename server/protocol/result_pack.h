// A result on the disk: every format, one after the other in one file.
#pragma once

#include <filesystem>
#include <string>

#include "server/jobs/job.h"

namespace lastflat::server {

/// A result in every format that it can be asked for.
struct JobOutput {
    std::string json, svg, glb, obj;
    std::string metrics;  ///< the JSON without coordinates
};

/// Writes the file and returns its digest and parts; it is on the disk when the call returns.
/// Throws: StoreError.
[[nodiscard]] Succeeded write_result_pack(const JobOutput& output,
                                          const std::filesystem::path& file);

}  // namespace lastflat::server
