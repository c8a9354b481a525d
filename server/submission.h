// The three ways to send a job, read into one.
#pragma once

#include "server/http/http.h"
#include "server/jobs/job.h"

namespace lastflat::server {

/// A request that cannot be taken.
class Refusal : public std::runtime_error {
public:
    explicit Refusal(api::Problem problem)
        : std::runtime_error(problem.detail), problem_(std::move(problem)) {}
    [[nodiscard]] const api::Problem& problem() const { return problem_; }

private:
    api::Problem problem_;
};

/// multipart/form-data with the parts `model` and, optional, `request`; application/json with the
/// model in base64; or the model's bytes alone, its constraints in the header
/// `X-Flatten-Constraints` (base64url) or absent.
/// Throws: Refusal, api::InvalidRequest, Error{unsupported_request}.
[[nodiscard]] JobInput read_submission(const http::Request& request);

}  // namespace lastflat::server
