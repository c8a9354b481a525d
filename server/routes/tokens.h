// Signed statements of what their holder may do.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/routes/grant.h"

namespace lastflat::server {

/// What a token says; it is signed and cannot be changed.
struct TokenClaims {
    std::string key;    ///< id of the key that made it; empty: the service was open
    std::string scope;  ///< "submit", "job:ID", "asset:ID"
    std::int64_t expires_ms = 0;
    std::vector<std::string> origins{};
};

/// Signs and reads tokens; nothing of them is kept.
class Tokens {
public:
    explicit Tokens(std::string secret) : secret_(std::move(secret)) {}

    static constexpr std::string_view prefix = "lastflat_token_";

    [[nodiscard]] std::string sealed(const TokenClaims& claims) const;
    /// Nothing if we did not sign it, or its time is over.
    [[nodiscard]] std::optional<TokenClaims> opened(std::string_view token) const;
    [[nodiscard]] static Grant grant_of(const TokenClaims& claims);

private:
    const std::string secret_;
};

}  // namespace lastflat::server
