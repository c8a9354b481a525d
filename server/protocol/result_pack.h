// A result on the disk: every format, plain and compressed, one after the other in one file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "server/jobs/job.h"

namespace lastflat::server {

struct Rendered {
    std::string bytes;
    std::string gzip;  ///< the same, compressed; empty unless asked for
};

/// A result in every format that it can be asked for.
struct JobOutput {
    Rendered json, svg, glb, obj;
    Rendered metrics;  ///< the JSON without coordinates
};

struct ResultPack {
    std::string digest;  ///< SHA-256 of the file
    std::vector<ResultPart> parts;
};

/// Writes the file; it is on the disk when the call returns. Throws: StoreError.
[[nodiscard]] ResultPack write_result_pack(const JobOutput& output,
                                           const std::filesystem::path& file);

}  // namespace lastflat::server
