#include "server/routes/tokens.h"

#include <nlohmann/json.hpp>

#include "api/base64.h"
#include "server/support/clock.h"
#include "server/support/crypto.h"

namespace lastflat::server {

std::string Tokens::sealed(const TokenClaims& claims) const {
    const std::string text = api::encode_base64url(nlohmann::json{
        {"key", claims.key},
        {"scope", claims.scope},
        {"expires_ms", claims.expires_ms},
        {"origins", claims.origins}}.dump());
    return std::string(prefix) + text + "." + api::encode_base64url(hmac_sha256(secret_, text));
}

std::optional<TokenClaims> Tokens::opened(std::string_view token) const {
    if (!token.starts_with(prefix)) return std::nullopt;
    token.remove_prefix(prefix.size());
    const std::size_t dot = token.find('.');
    if (dot == std::string_view::npos) return std::nullopt;
    const std::string_view text = token.substr(0, dot);
    const auto seal = api::decode_base64(token.substr(dot + 1));
    if (!seal || !equal_in_constant_time(*seal, hmac_sha256(secret_, text))) return std::nullopt;
    const auto json = nlohmann::json::parse(api::decode_base64(text).value());
    TokenClaims claims{json.at("key"), json.at("scope"), json.at("expires_ms"), json.at("origins")};
    if (claims.expires_ms <= now_ms()) return std::nullopt;
    return claims;
}

Grant Tokens::grant_of(const TokenClaims& claims) {
    const std::size_t colon = claims.scope.find(':');
    if (colon == std::string::npos) return {Grant::Kind::submit};
    return {claims.scope.starts_with("job:") ? Grant::Kind::job : Grant::Kind::asset,
            claims.scope.substr(colon + 1)};
}

}  // namespace lastflat::server
