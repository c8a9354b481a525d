#include "server/routes/grant.h"

#include <nlohmann/json.hpp>

#include "api/base64.h"
#include "server/support/clock.h"
#include "server/support/crypto.h"

namespace lastflat::server {
namespace {

constexpr std::string_view jobs_path = "/v1/jobs", assets_path = "/v1/assets";

bool is_look(std::string_view method, std::string_view path) {
    return method == "GET" || method == "HEAD" || (method == "POST" && path.ends_with("/map"));
}

/// Of a path under a job's: its id; else empty.
std::string job_of(std::string_view path) {
    if (!path.starts_with("/v1/jobs/")) return {};
    path.remove_prefix(jobs_path.size() + 1);
    return std::string(path.substr(0, path.find('/')));
}

bool is_submission(std::string_view method, std::string_view path) {
    if (method == "PUT") return !job_of(path).empty();
    return method == "POST" && (path == jobs_path || path == "/v1/validate");
}

bool allows_asset(const std::string& id, std::string_view method, std::string_view path,
                  const ModelOfJob& model_of_job) {
    if (is_submission(method, path)) return true;
    const bool looks = is_look(method, path);
    if (looks && path == std::string(assets_path) + "/" + id) return true;
    const bool cancels = method == "POST" && path.ends_with("/cancel");
    const std::string job = job_of(path);
    return (looks || cancels) && !job.empty() && model_of_job(job) == id;
}

}  // namespace

Grant grant_of(KeyScope scope) {
    switch (scope) {
        case KeyScope::all: return {Grant::Kind::all};
        case KeyScope::jobs: return {Grant::Kind::jobs};
        case KeyScope::read: break;
    }
    return {Grant::Kind::read};
}

bool allows(const Grant& grant, std::string_view method, std::string_view path,
            const ModelOfJob& model_of_job) {
    const bool submits = is_submission(method, path) || (method == "POST" && path == assets_path);
    switch (grant.kind) {
        case Grant::Kind::all: return true;
        case Grant::Kind::jobs:
            return is_look(method, path) || submits ||
                   (method == "POST" && (path == "/v1/jobs:batch" || path.ends_with("/cancel")));
        case Grant::Kind::read: return is_look(method, path);
        case Grant::Kind::submit: return submits;
        case Grant::Kind::job: return is_look(method, path) && job_of(path) == grant.id;
        case Grant::Kind::asset: return allows_asset(grant.id, method, path, model_of_job);
    }
    return false;
}

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
