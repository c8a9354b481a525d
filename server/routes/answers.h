// What answers have in common.
#pragma once

#include <string>

#include "server/http/http.h"
#include "server/jobs/refusal.h"

namespace lastflat::server {

[[nodiscard]] http::Response json_response(int status, std::string body);
[[nodiscard]] http::Response empty_response(int status);

/// The store cannot do its work now.
[[nodiscard]] api::Problem store_unavailable();

/// A problem document as a response; where it helps, with Retry-After.
[[nodiscard]] http::Response problem_response(const api::Problem& problem);

/// The handler with everything it may throw turned into an answer: the only catch of the handlers.
[[nodiscard]] http::Handler guarded(http::Handler handler);

/// Whether `If-None-Match` names the tag: the client has this already.
[[nodiscard]] bool has_already(const http::Request& request, const std::string& etag);

/// 304 with the tag if the client has it already, else the response with the tag.
[[nodiscard]] http::Response tagged(const http::Request& request, const std::string& etag,
                                    http::Response response);

/// `wait=n` of the Prefer header (RFC 7240), at most 60 s; nothing if it is absent or broken:
/// preferences never fail.
[[nodiscard]] std::optional<int> preferred_wait(const http::Request& request);

}  // namespace lastflat::server
