#include "api/token.h"

#include <algorithm>

#include "api/json.h"
#include "api/object_reader.h"
#include "api/timestamp.h"

namespace lastflat::api {
namespace {

constexpr double longest_s = 24.0 * 3600.0;
constexpr std::size_t most_origins = 8, longest_origin = 256;

/// "job:", "asset:" with an id behind; whether there is such a thing is seen when it is asked for.
bool is_scope(std::string_view scope) {
    if (scope == "submit") return true;
    const std::size_t colon = scope.find(':');
    if (colon == std::string_view::npos) return false;
    const std::string_view what = scope.substr(0, colon), id = scope.substr(colon + 1);
    const bool fits =
        what == "job" ? id.size() == 26 || id.size() == 36 : what == "asset" && id.size() == 64;
    return fits && std::all_of(id.begin(), id.end(), [](char c) {
               return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                      c == '-';
           });
}

}  // namespace

NewToken token_from_json(std::string_view text) {
    const nlohmann::json document = parse_json(text, 3);
    ObjectReader reader({document, ""});
    const auto scope = reader.find("scope"), expires = reader.find("expires_in_s"),
               origins = reader.find("origins");
    reader.finish();
    NewToken token;
    if (!scope) throw InvalidRequest("/scope", "must be given: submit, job:ID or asset:ID");
    token.scope = scope->text(80);
    if (!is_scope(token.scope)) scope->fail("must be submit, job:ID or asset:ID");
    if (expires) token.expires_in_s = static_cast<std::int64_t>(expires->number(1.0, longest_s));
    if (!origins) return token;
    for (const Field& origin : origins->items(most_origins)) {
        token.origins.push_back(origin.text(longest_origin));
        if (token.origins.back().find("://") == std::string::npos)
            origin.fail("must be an origin: https://shop.example");
    }
    return token;
}

std::string to_json(const Token& token) {
    return text_of({{"token", token.token}, {"expires_at", rfc3339(token.expires_ms)}});
}

}  // namespace lastflat::api
