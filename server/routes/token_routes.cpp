#include "server/routes/token_routes.h"

#include "api/refusal.h"
#include "api/token.h"
#include "server/routes/answers.h"
#include "server/support/clock.h"

namespace lastflat::server {

http::Route token_route(const Tokens& tokens) {
    const auto make = [&tokens](const http::Request& request) {
        if (request.body.empty() || request.body.front().media_type != "application/json")
            api::refuse("media_type_unsupported",
                        "what a token is for is sent as application/json");
        const api::NewToken asked = api::token_from_json(request.body.front().bytes);
        const TokenClaims claims{request.principal, asked.scope,
                                 now_ms() + 1000 * asked.expires_in_s, asked.origins};
        return json_response(201, to_json(api::Token{tokens.sealed(claims), claims.expires_ms}));
    };
    return {"POST", "/v1/tokens", make, true};
}

}  // namespace lastflat::server
