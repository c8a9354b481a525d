// What is thrown where something that was asked for is not done.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "api/problem.h"

namespace lastflat::api {

/// Ends as the problem that it holds. `what()` is for the operator.
class Refusal : public std::runtime_error {
public:
    Refusal(ProblemCode code, const std::string& detail) : Refusal(Problem(code, detail)) {}
    explicit Refusal(const Problem& problem) : Refusal(problem, problem.detail) {}
    /// `why` may say what the problem does not.
    Refusal(Problem problem, const std::string& why)
        : std::runtime_error(why), problem_(std::move(problem)) {}

    /// A header of the answer.
    Refusal& with_header(std::string name, std::string value) {
        headers_.emplace_back(std::move(name), std::move(value));
        return *this;
    }
    /// What is at fault stands in the request's content, not in its path.
    Refusal& in_content() {
        problem_.status = problem_.code.status_in_content();
        return *this;
    }

    [[nodiscard]] const Problem& problem() const { return problem_; }
    [[nodiscard]] const auto& headers() const { return headers_; }

protected:
    Problem problem_;

private:
    std::vector<std::pair<std::string, std::string>> headers_;
};

[[noreturn]] inline void refuse(ProblemCode code, const std::string& detail) {
    throw Refusal(code, detail);
}

}  // namespace lastflat::api
