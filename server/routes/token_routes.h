// Making tokens.
#pragma once

#include "server/http/http.h"
#include "server/routes/tokens.h"

namespace lastflat::server {

/// `tokens` must outlive the routes.
[[nodiscard]] http::Route token_route(const Tokens& tokens);

}  // namespace lastflat::server
