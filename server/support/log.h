// The log: one JSON object a line on standard error.
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

namespace lastflat::server {

/// Directs the log to standard error. Once, before other threads start.
void start_log();

/// Writes {"at": ..., "event": ..., fields...}. Whatever the fields hold, it stays one line:
/// control characters are escaped, broken UTF-8 is replaced. Never write a secret, a key or a
/// model's bytes.
void log_event(std::string_view event, const nlohmann::ordered_json& fields = {});

}  // namespace lastflat::server
