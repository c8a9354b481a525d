#include "server/routes/access.h"

#include <algorithm>

#include "api/refusal.h"
#include "server/http/text.h"
#include "server/routes/own_machine.h"
#include "server/support/clock.h"

namespace lastflat::server {
namespace {

constexpr std::int64_t window_ms = 60'000;
constexpr std::string_view scheme = "bearer ";

/// What follows the scheme, whose case does not matter.
std::optional<std::string_view> bearer(std::string_view header) {
    if (http::lower_case(header.substr(0, scheme.size())) != scheme) return std::nullopt;
    return header.substr(scheme.size());
}

/// The origin of the web page that sends the request: an image has no Origin, but a Referer.
std::string_view page_of(const http::Request& request) {
    const std::string_view origin = request.header("origin");
    if (!origin.empty()) return origin;
    const std::string_view referer = request.header("referer");
    const std::size_t host = referer.find("://");
    if (host == std::string_view::npos) return {};
    return referer.substr(0, referer.find('/', host + 3));
}

}  // namespace

void Access::admit(http::Request& request) {
    allow_origin(request);
    if (request.method == "OPTIONS" || request.path.rfind("/v1/", 0) != 0) return;
    const Grant grant = check_key(request);
    count(request);
    const auto model_of_job = [&](const std::string& id) {
        const auto job = jobs_.find(request.principal, id);
        return job ? job->model : std::string();
    };
    if (!allows(grant, request.method, request.path, model_of_job))
        api::refuse("scope_refused", "this key or token is for something else than " +
                                         request.method + " " + request.path);
    if (grant.kind == Grant::Kind::asset) request.restriction = grant.id;
    request.is_limited = grant.kind != Grant::Kind::all;
}

Grant Access::check_key(http::Request& request) {
    const bool open = !keys_.has_keys();
    if (open) {
        check_client(request);
        check_page(request, rules_.listen_host, rules_.allowed_origins);
    }
    auto key = bearer(request.header("authorization"));
    if (const auto token = request.query.find("token"); !key && token != request.query.end())
        key = token->second;
    if (key && (request.query.contains("token") || key->starts_with(Tokens::prefix)))
        return check_token(request, *key, open);
    if (open) return {};
    if (!key) api::refuse("key_missing", "send your API key: Authorization: Bearer KEY");
    const auto good = keys_.check(*key);
    if (!good)
        api::refuse("key_unknown", "this API key is not known, was revoked, or its time is over");
    request.principal = good->id;
    return grant_of(good->scope);
}

Grant Access::check_token(http::Request& request, std::string_view token, bool open) {
    const auto claims = tokens_.opened(token);
    if (!claims || (open ? !claims->key.empty() : !keys_.is_good(claims->key)))
        api::refuse("token_invalid",
                    "this token is not one, its time is over, or its key is no longer good");
    const auto& origins = claims->origins;
    if (!origins.empty() &&
        std::find(origins.begin(), origins.end(), page_of(request)) == origins.end())
        api::refuse("origin_refused", "this token is for other web pages");
    request.principal = claims->key;
    return Tokens::grant_of(*claims);
}

void Access::count(http::Request& request) {
    const bool live = request.path.starts_with("/v1/sessions/");
    const std::size_t rate = live ? rules_.session_rate : rules_.rate;
    if (rate == 0 || request.principal.empty()) return;
    std::size_t left = 0;
    bool over = false;
    std::int64_t seconds = 0;
    {
        const std::scoped_lock lock(mutex_);
        Window& window = (live ? session_windows_ : windows_)[request.principal];
        const std::int64_t now = now_ms();
        if (now - window.begin_ms >= window_ms || now < window.begin_ms) window = {now, 0};
        over = window.requests >= rate;
        if (!over) ++window.requests;
        left = rate - window.requests;
        seconds = (window.begin_ms + window_ms - now + 999) / 1000;
    }
    const std::string policy = live ? "\"sessions\"" : "\"default\"";
    request.answer_headers.emplace_back("RateLimit-Policy",
                                        policy + ";q=" + std::to_string(rate) + ";w=60");
    request.answer_headers.emplace_back(
        "RateLimit", policy + ";r=" + std::to_string(left) + ";t=" + std::to_string(seconds));
    if (over)
        throw api::Refusal("rate_exceeded",
                           "this API key may send " + std::to_string(rate) +
                               (live ? " requests a minute to live sessions (--session-rate)"
                                     : " requests a minute (--rate)"))
            .with_header("Retry-After", std::to_string(seconds));
}

std::vector<std::pair<std::string, std::string>> Access::origin_headers(
    std::string_view origin) const {
    const auto& allowed = rules_.allowed_origins;
    if (allowed.empty()) return {};
    std::vector<std::pair<std::string, std::string>> headers{{"Vary", "Origin"}};
    if (origin.empty() || std::find(allowed.begin(), allowed.end(), origin) == allowed.end())
        return headers;
    headers.emplace_back("Access-Control-Allow-Origin", origin);
    headers.emplace_back("Access-Control-Expose-Headers",
                         "Location, ETag, Retry-After, X-Request-Id, RateLimit, RateLimit-Policy, "
                         "Preference-Applied, Idempotent-Replayed, Link, Content-Disposition");
    return headers;
}

void Access::allow_origin(http::Request& request) const {
    const auto headers = origin_headers(request.header("origin"));
    request.answer_headers.insert(request.answer_headers.end(), headers.begin(), headers.end());
    if (headers.size() < 2 || request.method != "OPTIONS") return;
    request.answer_headers.emplace_back("Access-Control-Allow-Methods",
                                        "GET, HEAD, POST, PUT, PATCH, DELETE");
    request.answer_headers.emplace_back(
        "Access-Control-Allow-Headers",
        "Authorization, Content-Type, Content-Digest, Idempotency-Key, Prefer, Cancel-After, "
        "Cache-Control, Job-Priority, X-Flatten-Constraints, X-Request-Id, If-None-Match, "
        "Last-Event-ID, Range");
    request.answer_headers.emplace_back("Access-Control-Max-Age", "600");
}

}  // namespace lastflat::server
