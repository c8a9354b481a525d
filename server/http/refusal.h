// Why a request is not handed to its handler, said so that the caller can mend it.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/http/http.h"

namespace lastflat::http {

/// Thrown by whatever reads a request. `what()` says what is wrong and what to do about it.
class Refusal : public std::runtime_error {
public:
    Refusal(int status, std::string code, const std::string& detail)
        : std::runtime_error(detail), status_(status), code_(std::move(code)) {}

    Refusal& with_header(std::string name, std::string value) {
        headers_.emplace_back(std::move(name), std::move(value));
        return *this;
    }
    /// The answer to a HEAD request has no body, also when it is a refusal.
    Refusal& without_body() {
        without_body_ = true;
        return *this;
    }

    /// The web page that asks, as far as the request was read.
    Refusal& from_origin(std::string_view origin) {
        origin_ = origin;
        return *this;
    }

    [[nodiscard]] int status() const { return status_; }
    [[nodiscard]] const std::string& code() const { return code_; }
    [[nodiscard]] bool is_without_body() const { return without_body_; }
    [[nodiscard]] const std::string& origin() const { return origin_; }
    [[nodiscard]] const auto& headers() const { return headers_; }

private:
    int status_;
    std::string code_, origin_;
    bool without_body_ = false;
    std::vector<std::pair<std::string, std::string>> headers_;
};

/// 503: there is more to do than can be taken.
[[nodiscard]] Refusal overloaded();

/// The problem document of a refusal. Never throws: a problem maker that does gets a bare answer.
[[nodiscard]] Response answer_to(const Refusal& refusal, const ProblemMaker& problem) noexcept;

}  // namespace lastflat::http
