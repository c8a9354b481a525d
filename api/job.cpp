#include "api/job.h"

#include <cmath>

#include "api/json.h"
#include "api/timestamp.h"

namespace lastflat::api {
namespace {

double tenths(double seconds) {
    return std::round(10.0 * seconds) / 10.0;
}

}  // namespace

Json json_of(const Job& job) {
    const std::string_view state = word_of(job_states, job.state);
    Json json{{"id", job.id}, {"state", state}};
    if (!job.reason.empty()) json["reason"] = job.reason;
    if (!job.tag.empty()) json["tag"] = job.tag;
    if (!job.batch.empty()) json["batch"] = job.batch;
    json["priority"] = word_of(job_priorities, job.priority);
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
    if (job.cached) json["cached"] = true;
    json["progress"] = {{"stage", job.stage.empty() ? state : job.stage}, {"percent", job.percent}};
    if (job.remaining_s) json["progress"]["remaining_s"] = tenths(*job.remaining_s);
    if (job.queue_position) json["queue"] = {{"position", *job.queue_position}};
    if (job.queue_position && job.queue_s) json["queue"]["eta_s"] = tenths(*job.queue_s);
    if (job.error) json["error"] = json_of(*job.error);
    const std::string self = "/v1/jobs/" + job.id;
    json["links"] = {{"self", self},
                     {"result", self + "/result"},
                     {"metrics", self + "/metrics"},
                     {"events", self + "/events"},
                     {"cancel", self + "/cancel"}};
    return json;
}

Json counts_json(const std::map<JobState, std::size_t>& states) {
    Json json = Json::object();
    for (const auto& [state, jobs] : states) json[std::string(word_of(job_states, state))] = jobs;
    return json;
}

std::string to_json(const Job& job) {
    return text_of(json_of(job));
}

std::string to_json(const Job& job, std::string_view result) {
    std::string text = to_json(job);
    text.back() = ',';  // a result is large: it is not read again
    text.append("\"result\":").append(result).append("}");
    return text;
}

std::string to_json(const JobList& list) {
    Json json{{"items", json_of(list.items)}};
    if (!list.next_cursor.empty()) json["next_cursor"] = list.next_cursor;
    return text_of(json);
}

}  // namespace lastflat::api
