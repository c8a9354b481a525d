// Who may ask: API keys, their rate, and the web pages that may call.
#pragma once

#include <map>
#include <mutex>

#include "server/http/http.h"
#include "server/jobs/job_store.h"
#include "server/routes/tokens.h"

namespace lastflat::server {

struct AccessRules {
    std::size_t rate = 6000;                   ///< requests of one key in a minute; 0: any number
    std::vector<std::string> allowed_origins;  ///< web pages that may call (CORS)
    std::string listen_host;                   ///< what the service may be asked as
    std::size_t session_rate = 12'000;         ///< as `rate`, of those to one of its live sessions
};

/// Decides about every request before its body is read. With at least one key, every path under
/// /v1 needs a good one; without any, only this machine's user is answered (own_machine.h). A token
/// goes in the key's place, or into the field `token` of the query; it is good as long as its key.
class Access {
public:
    /// All must outlive it.
    Access(KeyStore& keys, JobStore& jobs, const Tokens& tokens, AccessRules rules)
        : keys_(keys), jobs_(jobs), tokens_(tokens), rules_(std::move(rules)) {}

    /// Sets the principal and the headers of the answer. Throws: api::Refusal (401, 403, 429),
    /// StoreError.
    void admit(http::Request& request);
    /// What lets a web page of this origin read the answer: nothing unless it is on the list.
    [[nodiscard]] std::vector<std::pair<std::string, std::string>> origin_headers(
        std::string_view origin) const;

private:
    [[nodiscard]] Grant check_key(http::Request& request);
    [[nodiscard]] Grant check_token(http::Request& request, std::string_view token, bool open);
    void count(http::Request& request);
    void allow_origin(http::Request& request) const;

    struct Window {
        std::int64_t begin_ms = 0;
        std::size_t requests = 0;
    };
    KeyStore& keys_;
    JobStore& jobs_;
    const Tokens& tokens_;
    const AccessRules rules_;
    std::mutex mutex_;
    std::map<std::string, Window> windows_, session_windows_;  ///< by key
};

}  // namespace lastflat::server
