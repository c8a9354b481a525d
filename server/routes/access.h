// Who may ask: API keys, their rate, and the web pages that may call.
#pragma once

#include <map>
#include <mutex>

#include "server/http/http.h"
#include "server/jobs/key_store.h"

namespace lastflat::server {

struct AccessRules {
    std::size_t rate = 6000;                   ///< requests of one key in a minute; 0: any number
    std::vector<std::string> allowed_origins;  ///< web pages that may call (CORS)
    std::string listen_host;                   ///< what the service may be asked as
};

/// Decides about every request before its body is read. With at least one key, every path under
/// /v1 needs a good one; without any, only this machine's user is answered (own_machine.h).
class Access {
public:
    /// `keys` must outlive it.
    Access(KeyStore& keys, AccessRules rules) : keys_(keys), rules_(std::move(rules)) {}

    /// Sets the principal and the headers of the answer. Throws: api::Refusal (401, 403, 429),
    /// StoreError.
    void admit(http::Request& request);
    /// What lets a web page of this origin read the answer: nothing unless it is on the list.
    [[nodiscard]] std::vector<std::pair<std::string, std::string>> origin_headers(
        std::string_view origin) const;

private:
    void check_key(http::Request& request);
    void count(http::Request& request);
    void allow_origin(http::Request& request) const;

    struct Window {
        std::int64_t begin_ms = 0;
        std::size_t requests = 0;
    };
    KeyStore& keys_;
    const AccessRules rules_;
    std::mutex mutex_;
    std::map<std::string, Window> windows_;  ///< by key
};

}  // namespace lastflat::server
