#include "server/support/log.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include "api/timestamp.h"
#include "server/support/clock.h"

namespace lastflat::server {

void start_log() {
    spdlog::set_default_logger(spdlog::stderr_logger_mt("lastflat"));
    spdlog::set_pattern("%v");
}

void log_event(std::string_view event, const nlohmann::ordered_json& fields) {
    nlohmann::ordered_json line{{"at", api::rfc3339(now_ms())}, {"event", event}};
    for (const auto& [name, value] : fields.items()) line[name] = value;
    spdlog::info("{}", line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

}  // namespace lastflat::server
