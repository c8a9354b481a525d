// What answers have in common.
#pragma once

#include <stdexcept>
#include <string>

#include "api/problem.h"
#include "server/http/http.h"

namespace lastflat::server {

/// A request that cannot be met; becomes its problem document.
class Refusal : public std::runtime_error {
public:
    explicit Refusal(api::Problem problem)
        : std::runtime_error(problem.detail), problem_(std::move(problem)) {}
    [[nodiscard]] const api::Problem& problem() const { return problem_; }

private:
    api::Problem problem_;
};

[[noreturn]] void refuse(int status, const char* code, const std::string& detail);

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
