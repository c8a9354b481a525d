#include "server/protocol/work_messages.h"

#include <algorithm>
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

namespace {

std::string line_of(const StageReached& reached) {
    return "progress " + Json{{"stage", reached.stage}, {"fraction", reached.fraction}}.dump();
}
std::string line_of(const Succeeded& end) {
    return "result " +
           Json{{"digest", end.result}, {"parts", Json::parse(to_json(end.parts))}}.dump();
}
std::string line_of(const Failed& end) {
    return "problem " + api::to_json(end.problem);
}
std::string line_of(const Report& report) {
    return "report " + report.content;
}
std::string line_of(const Retry& retry) {
    std::string why = retry.why;
    std::replace(why.begin(), why.end(), '\n', ' ');
    return "retry " + why;
}

std::optional<WorkMessage> message_of(std::string_view kind, std::string_view content) {
    if (kind == "problem") return Failed{api::problem_from_json(content)};
    if (kind == "report") return Report{std::string(content)};
    if (kind == "retry") return Retry{std::string(content)};
    if (kind == "progress") {
        const auto json = Json::parse(content);
        return StageReached{json.at("stage"), json.at("fraction")};
    }
    if (kind == "result") {
        const auto json = Json::parse(content);
        return Succeeded{json.at("digest"), result_parts_of(json.at("parts").dump())};
    }
    return std::nullopt;
}

}  // namespace

std::string to_line(const WorkMessage& message) {
    return std::visit([](const auto& said) { return line_of(said); }, message) + "\n";
}

std::optional<WorkMessage> work_message_of(std::string_view line) {
    const std::size_t end = std::min(line.find(' '), line.size());
    try {
        return message_of(line.substr(0, end), line.substr(std::min(end + 1, line.size())));
    } catch (const std::exception&) {
        return std::nullopt;
    }
}

}  // namespace lastflat::server
