#include "server/protocol/work_messages.h"

#include <nlohmann/json.hpp>

#include "server/jobs/result_parts.h"

namespace lastflat::server {

using Json = nlohmann::ordered_json;

std::string to_line(const WorkOrder& order) {
    const Json json{{"task", order.task},           {"model", order.model},
                    {"digest", order.digest},       {"request", order.request},
                    {"result", order.result},       {"threads", order.threads},
                    {"memory_mb", order.memory_mb}, {"cpu_seconds", order.cpu_seconds},
                    {"parent", order.parent}};
    return json.dump(-1, ' ', true) + "\n";
}

WorkOrder work_order_of(std::string_view line) {
    const auto json = Json::parse(line);
    return {json.at("task"),      json.at("model"),       json.at("digest"),
            json.at("request"),   json.at("result"),      json.at("threads"),
            json.at("memory_mb"), json.at("cpu_seconds"), json.at("parent")};
}

std::optional<WorkMessage> work_message_of(std::string_view line) {
    const auto json = Json::parse(line, nullptr, false);
    if (!json.is_object()) return std::nullopt;
    WorkMessage message;
    try {
        if (json.contains("stage")) {
            message.progress.emplace(json.at("stage"), json.at("fraction"));
        } else if (json.contains("problem")) {
            message.outcome.emplace();
            message.outcome->error = json.at("problem").dump();
        } else if (json.contains("digest")) {
            message.outcome.emplace();
            message.outcome->result = json.at("digest");
            message.outcome->parts = result_parts_of(json.at("parts").dump());
        } else if (json.contains("report")) {
            message.report = json.at("report").dump();
        } else {
            message.retry = json.at("retry");
        }
    } catch (const nlohmann::json::exception&) {
        return std::nullopt;
    }
    return message;
}

}  // namespace lastflat::server
