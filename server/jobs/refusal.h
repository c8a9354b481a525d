// What is thrown where something that was asked for is not done.
#pragma once

#include <stdexcept>
#include <string>

#include "api/problem.h"

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

[[noreturn]] inline void refuse(int status, const char* code, const std::string& detail) {
    throw Refusal({status, code, "", detail, std::nullopt, std::nullopt});
}

}  // namespace lastflat::server
