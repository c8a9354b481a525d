// What an operator may set.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lastflat::server {

struct Address {
    std::string host;
    int port = 0;
};

enum class WebhookTargets { none, anywhere_public, anywhere };

struct Settings {
    Address listen{"127.0.0.1", 8080};
    std::optional<Address> admin;  ///< of health, readiness and metrics
    std::string data = "lastflat-data";
    std::size_t workers = 0;                 ///< 0: one for each core
    std::size_t queue = 1024;                ///< jobs waiting
    std::size_t queue_per_key = 200;         ///< of one API key
    std::size_t assets_per_key_mb = 4096;    ///< models that one API key may leave here
    std::size_t storage_per_key_mb = 16384;  ///< models, results and assets of one API key
    std::size_t min_free_mb = 512;           ///< of the disk; with less, no new work is taken
    std::size_t max_body_mb = 256;           ///< of one request
    std::size_t connections = 64;            ///< served at once
    std::size_t streams = 64;                ///< long polls and event streams at once
    std::size_t rate = 6000;                 ///< requests of one key in a minute; 0: any number
    std::size_t sessions = 8, sessions_per_key = 2;  ///< live ones
    std::size_t session_rate = 12'000;  ///< requests of one key to them in a minute; 0: any number
    int session_memory_mb = 2048;       ///< of one of them; 0: no limit
    std::int64_t session_idle_ms = 600'000;  ///< after which one that nobody asks ends
    int job_memory_mb = 4096;                ///< of one job; 0: no limit
    std::int64_t job_time_ms = 300'000;
    std::int64_t lease_ms = 60'000;
    std::int64_t result_ms = 24 * 3600'000LL;   ///< how long a result is kept
    std::int64_t job_ms = 7 * 24 * 3600'000LL;  ///< how long a finished job is kept
    std::int64_t grace_ms = 20'000;             ///< for running jobs when the service ends
    WebhookTargets webhooks = WebhookTargets::none;
    std::vector<std::string> allowed_origins;  ///< web pages that may call (CORS)
    std::vector<std::string> trusted_proxies;  ///< addresses whose X-Forwarded-For is believed
};

}  // namespace lastflat::server
