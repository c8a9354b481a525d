#include "api/job.h"

#include <cmath>
#include <cstdio>
#include <ctime>
#include <nlohmann/json.hpp>

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

std::optional<std::int64_t> rfc3339_ms(const std::string& text) {
    std::tm utc{};
    const char* rest = strptime(text.c_str(), "%Y-%m-%dT%H:%M:%S", &utc);
    if (rest == nullptr) return std::nullopt;
    std::int64_t milliseconds = 0;
    if (*rest == '.') {
        int digits = 0;
        for (++rest; *rest >= '0' && *rest <= '9'; ++rest, ++digits) {
            if (digits < 3) milliseconds = 10 * milliseconds + (*rest - '0');
        }
        for (; digits > 0 && digits < 3; ++digits) milliseconds *= 10;
    }
    if (std::string_view(rest) != "Z") return std::nullopt;
    return std::int64_t{timegm(&utc)} * 1000 + milliseconds;
}

namespace {

double tenths(double seconds) {
    return std::round(10.0 * seconds) / 10.0;
}

}  // namespace

std::string to_json(const Job& job) {
    nlohmann::ordered_json json{{"id", job.id}, {"state", job.state}};
    if (!job.reason.empty()) json["reason"] = job.reason;
    if (!job.tag.empty()) json["tag"] = job.tag;
    if (!job.batch.empty()) json["batch"] = job.batch;
    const auto time = [&](const char* name, const std::optional<std::int64_t>& at_ms) {
        if (at_ms) json[name] = rfc3339(*at_ms);
    };
    time("created_at", job.created_ms);
    time("started_at", job.started_ms);
    time("finished_at", job.finished_ms);
    time("cancel_at", job.cancel_at_ms);
    time("result_expires_at", job.result_expires_ms);
    time("expires_at", job.expires_ms);
    json["attempt"] = job.attempt;
    json["progress"] = {{"stage", job.stage}, {"percent", job.percent}};
    if (job.remaining_s) json["progress"]["remaining_s"] = tenths(*job.remaining_s);
    if (job.queue_position) json["queue"] = {{"position", *job.queue_position}};
    if (job.queue_position && job.queue_s) json["queue"]["eta_s"] = tenths(*job.queue_s);
    if (!job.error.empty()) json["error"] = nlohmann::ordered_json::parse(job.error);
    const std::string self = "/v1/jobs/" + job.id;
    json["links"] = {{"self", self},
                     {"result", self + "/result"},
                     {"metrics", self + "/metrics"},
                     {"events", self + "/events"},
                     {"cancel", self + "/cancel"}};
    return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace lastflat::api
