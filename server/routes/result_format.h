// Which format of a result a client wants.
#pragma once

#include <optional>

#include "api/result_format.h"
#include "server/http/http.h"

namespace lastflat::server {

using api::ResultFormat;

/// `?format=` decides; else `Accept`, by its weights, the first of ours among equals; JSON if
/// neither is given.
/// Throws: api::Refusal 406 with the list of what there is, 400 for an unknown `format`.
[[nodiscard]] ResultFormat negotiated_format(const http::Request& request);

/// Whether `Accept-Encoding` takes gzip.
[[nodiscard]] bool accepts_gzip(const http::Request& request);

struct ByteRange {
    std::uint64_t first = 0, last = 0;
};
/// The one range that `Range: bytes=` asks for, within `size` bytes; nothing if the header is
/// absent or of another kind and thus ignored. Throws: api::Refusal 416 if it lies outside.
[[nodiscard]] std::optional<ByteRange> wanted_range(const http::Request& request,
                                                    std::uint64_t size);

}  // namespace lastflat::server
