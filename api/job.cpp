#include "api/job.h"

#include <cstdio>
#include <ctime>

#include "api/problem_json.h"

namespace lastflat::api {

std::string rfc3339(std::int64_t milliseconds) {
    const auto seconds = static_cast<std::time_t>(milliseconds / 1000);
    std::tm utc{};
    gmtime_r(&seconds, &utc);
    char text[64];
    std::snprintf(text, sizeof text, "%04d-%02d-%02dT%02d:%02d:%02d.%03dZ", utc.tm_year + 1900,
                  utc.tm_mon + 1, utc.tm_mday, utc.tm_hour, utc.tm_min, utc.tm_sec,
                  static_cast<int>(milliseconds % 1000));
    return text;
}

std::string to_json(const Job& job) {
    nlohmann::ordered_json json{{"id", job.id}, {"state", job.state}};
    if (!job.tag.empty()) json["tag"] = job.tag;
    json["created_at"] = rfc3339(job.created_ms);
    if (job.started_ms) json["started_at"] = rfc3339(*job.started_ms);
    if (job.finished_ms) json["finished_at"] = rfc3339(*job.finished_ms);
    json["progress"] = {{"stage", job.stage}, {"percent", job.percent}};
    if (job.queue_position) json["queue"] = {{"position", *job.queue_position}};
    if (job.error) json["error"] = problem_json(*job.error);
    json["links"] = {{"self", "/v1/jobs/" + job.id},
                     {"result", "/v1/jobs/" + job.id + "/result"},
                     {"cancel", "/v1/jobs/" + job.id + "/cancel"}};
    return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace lastflat::api
