// Short-lived credentials that may do one thing, for web pages.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lastflat::api {

/// What a client asks for.
struct NewToken {
    std::string scope;  ///< "submit", "job:ID", "asset:ID"
    std::int64_t expires_in_s = 3600;
    std::vector<std::string> origins;  ///< web pages that may use it; empty: anybody
};

/// Throws: InvalidRequest naming the field.
[[nodiscard]] NewToken token_from_json(std::string_view text);

struct Token {
    std::string token;
    std::int64_t expires_ms;  ///< since 1970
};
[[nodiscard]] std::string to_json(const Token& token);

}  // namespace lastflat::api
