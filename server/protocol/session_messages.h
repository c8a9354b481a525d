// What the service and the worker of a live session say to each other, after its order: of every
// ask and every answer a line, and its bytes behind it as they are, whatever they are.
//
//   service -> worker   {"number": 7, "kind": 0, "sequence": 41, "points": true, "bytes": 512}
//   worker -> service   {"number": 7, "bytes": 81234}   or   {"number": 7, "problem": {...}}
#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>

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

/// The line and, behind it, the text.
[[nodiscard]] std::string to_bytes(const SessionAsk& ask);
/// Waits for the next ask; nothing at the end. Throws: nlohmann::json::exception.
[[nodiscard]] std::optional<SessionAsk> read_session_ask(std::istream& from);

/// The line and, behind it, the body.
[[nodiscard]] std::string to_bytes(const SessionAnswer& answer);

/// Takes the first answer from what was read, once it is whole.
/// Throws: std::runtime_error, nlohmann::json::exception if that is no answer.
[[nodiscard]] std::optional<SessionAnswer> take_session_answer(std::string& read);

}  // namespace lastflat::server
