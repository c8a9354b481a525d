// What answers have in common.
#pragma once

#include <string>

#include "api/refusal.h"
#include "server/http/http.h"

namespace lastflat::server {

[[nodiscard]] http::Response json_response(int status, std::string body);
[[nodiscard]] http::Response empty_response(int status);

/// What the client is told of what was thrown: an internal error is logged instead.
[[nodiscard]] api::Refusal refusal_to(const http::Request& request,
                                      const std::exception_ptr& thrown);

/// The same as a response, where it helps with Retry-After.
[[nodiscard]] http::Response answer_to(const http::Request& request,
                                       const std::exception_ptr& thrown);

/// Whether `If-None-Match` names the tag: the client has this already.
[[nodiscard]] bool has_already(const http::Request& request, const std::string& etag);

/// 304 with the tag if the client has it already, else the response with the tag.
[[nodiscard]] http::Response tagged(const http::Request& request, const std::string& etag,
                                    http::Response response);

/// `wait=n` of the Prefer header (RFC 7240), at most 60 s; nothing if it is absent or broken
/// (preferences never fail), or after a body of more than 16 MiB: it would stay in memory, and in
/// the share that all bodies have.
[[nodiscard]] std::optional<int> preferred_wait(const http::Request& request);

}  // namespace lastflat::server
