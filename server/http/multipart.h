// multipart/form-data bodies, from raw bytes to parts.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "server/http/http.h"

namespace lastflat::http {

/// Splits a body into its parts.
///
/// Paper:  RFC 7578 (form-data) over RFC 2046, section 5.1 (boundaries).
/// In:     the Content-Type value, for its boundary; the whole body.
/// Out:    the parts in their order, their bytes inside `body`; names may repeat. `filename*` is
///         ignored, as RFC 7578 asks.
/// Throws: api::Refusal, also for a body that lacks its last boundary: it was cut off.
[[nodiscard]] std::vector<BodyPart> parse_multipart(std::string_view content_type,
                                                    std::string_view body, std::size_t most_parts);

}  // namespace lastflat::http
