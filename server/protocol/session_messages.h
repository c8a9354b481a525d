// What the service and the worker of a live session say to each other, after its order: one ask a
// line; of every answer one line, and its body behind it.
//
//   service -> worker   {"number": 7, "kind": "change", "sequence": 41, "points": true, "text":
//   ...} worker -> service   {"number": 7, "bytes": 81234}           and so many bytes
//                       {"number": 7, "problem": {...}}
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "api/problem.h"

namespace lastflat::server {

enum class AskKind {
    change,   ///< `text`: a merge patch of the request; answers what changed
    state,    ///< everything, as if it had just changed, and the request
    request,  ///< only that
    surface,  ///< GLB
    map,      ///< `text`: what to map
    compare   ///< how far the pattern is from a job's: {"difference_mm"}
};

struct SessionAsk {
    std::uint64_t number = 0;  ///< ascending; 0 is the opening, which nobody asks for
    AskKind kind = AskKind::state;
    std::uint64_t sequence = 0;  ///< of a change
    bool points = false;         ///< not JSON, but `api::session_points`
    std::string text{};
};

struct SessionAnswer {
    std::uint64_t number = 0;
    std::optional<api::Problem> problem{};
    std::string body{};
};

[[nodiscard]] std::string to_line(const SessionAsk& ask);
/// Throws: nlohmann::json::exception.
[[nodiscard]] SessionAsk session_ask_of(std::string_view line);

/// The line and, behind it, the body.
[[nodiscard]] std::string to_bytes(const SessionAnswer& answer);

/// Takes the first answer from what was read, once it is whole.
/// Throws: std::runtime_error, nlohmann::json::exception if that is no answer.
[[nodiscard]] std::optional<SessionAnswer> take_session_answer(std::string& read);

}  // namespace lastflat::server
