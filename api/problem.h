// Problem documents (RFC 9457): what every error looks like on the wire.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lastflat::api {

/// One of several demands that cannot all be met.
struct ConflictMember {
    std::string pointer;  ///< the field of the request
    std::string title;
    double off_mm;                   ///< at the best compromise
    std::array<double, 3> position;  ///< where on the last, mm
};

struct Problem {
    int status = 500;
    std::string code;                               ///< stable, for programs
    std::string title;                              ///< the code in words; empty: made from it
    std::string detail;                             ///< what, where, and the mend, for people
    std::optional<std::string> pointer;             ///< the field of the request at fault
    std::optional<std::array<double, 3>> position;  ///< the place on the last, mm
    std::vector<std::array<std::int32_t, 3>> triangles{};  ///< at fault, by vertex ids of the file
    std::vector<ConflictMember> conflict{};
};

/// application/problem+json.
[[nodiscard]] std::string to_json(const Problem& problem);

}  // namespace lastflat::api
