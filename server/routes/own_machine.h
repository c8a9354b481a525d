// A service without keys is for the user of its own machine alone.
#pragma once

#include <string>
#include <vector>

#include "server/http/http.h"

namespace lastflat::server {

/// The request comes from this machine, and no proxy handed it on.
/// Throws: api::Refusal (401 `no_keys`).
void check_client(const http::Request& request);

/// No web page sent it but the service's own and those allowed: a page that the user looks at may
/// send requests to this machine, too, and by a name of its own for this machine's address
/// (DNS rebinding) even read the answers.
/// Throws: api::Refusal (403 `host_refused`, `origin_refused`).
void check_page(const http::Request& request, const std::string& listen_host,
                const std::vector<std::string>& allowed_origins);

/// An address of this machine that no other reaches, or a name for it, in small letters.
[[nodiscard]] bool is_loopback(const std::string& address);

}  // namespace lastflat::server
