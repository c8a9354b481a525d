// Problem documents (RFC 9457): what every error looks like on the wire.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/problem_catalogue.h"

namespace lastflat::api {

/// One of several demands that cannot all be met.
struct ConflictMember {
    std::string pointer;  ///< the field of the request
    std::string title;
    double off_mm;                   ///< at the best compromise
    std::array<double, 3> position;  ///< where on the last, mm
};

struct Problem {
    Problem(ProblemCode of, std::string what) : code(of), detail(std::move(what)) {}

    ProblemCode code;
    std::string detail;  ///< what, where, and the mend, for people
    int status = code.status();
    std::optional<std::string> pointer{};                  ///< the field of the request at fault
    std::optional<std::array<double, 3>> position{};       ///< where on the last, mm
    std::vector<std::array<std::int32_t, 3>> triangles{};  ///< at fault, by vertex ids of the file
    std::vector<ConflictMember> conflict{};

    /// Whether the caller can mend it, or the program is at fault.
    [[nodiscard]] bool is_bad_input() const { return status < 500; }
};

/// application/problem+json.
[[nodiscard]] std::string to_json(const Problem& problem);

/// Reads what `to_json` wrote. Throws: std::runtime_error if it did not.
[[nodiscard]] Problem problem_from_json(std::string_view text);

/// What whoever asks for the result of a job that failed with `problem` is told.
[[nodiscard]] Problem without_result(const Problem& problem);

}  // namespace lastflat::api
