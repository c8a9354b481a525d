// Which format of a result a client wants.
#pragma once

#include "server/http/http.h"
#include "server/jobs/job.h"

namespace lastflat::server {

enum class ResultFormat { json, svg, glb, obj };

/// `?format=` decides; else `Accept`, by its weights, the first of ours among equals; JSON if
/// neither is given.
/// Throws: Refusal 406 with the list of what there is, 400 for an unknown `format`.
[[nodiscard]] ResultFormat negotiated_format(const http::Request& request);

[[nodiscard]] std::string media_type(ResultFormat format);
[[nodiscard]] std::string file_ending(ResultFormat format);
[[nodiscard]] Bytes bytes_of(const JobOutput& output, ResultFormat format);

}  // namespace lastflat::server
