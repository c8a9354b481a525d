#include "server/routes/job_routes.h"

#include <charconv>

#include "api/base64.h"
#include "api/job.h"
#include "server/http/text.h"
#include "server/routes/answers.h"
#include "server/routes/job_view.h"
#include "server/routes/submit.h"
#include "server/routes/waiting_place.h"
#include "server/support/crypto.h"

namespace lastflat::server {
namespace {

using http::Request;
using http::Response;
using Clock = JobWatch::Clock;

constexpr std::size_t most_listed = 200;
constexpr std::size_t most_waiting_body = 16u << 20;
constexpr std::size_t code_bytes = 12;  ///< of a cursor's signature

/// Waits until the job has ended, or differs from what the client has, or the time is over.
JobRecord wait_for(Service& service, const Request& request, JobRecord job, int seconds) {
    const WaitingPlace place(service, request);
    if (!place.is_taken()) return job;
    const auto deadline = Clock::now() + std::chrono::seconds(seconds);
    JobWatch::Subscription subscription(service.watch, job.id);
    const bool until_change = request.headers.contains("if-none-match");
    for (;;) {
        job = found_job(service, request.principal, job.id);
        if (is_final(job.state)) return job;
        if (until_change && !has_already(request, job_etag(service, job))) return job;
        if (!subscription.wait_until(deadline)) return job;
    }
}

Response job_response(Service& service, const JobRecord& job, int status) {
    Response response = json_response(status, job_json(service, job));
    if (!is_final(job.state)) response.headers.emplace_back("Retry-After", "1");
    return response;
}

/// The job with its result inside.
Response finished_response(Service& service, const JobRecord& job) {
    std::string text = job_json(service, job);
    if (job.state == JobState::succeeded && !job.result.empty()) {
        text.pop_back();
        text += ",\"result\":" + result_bytes(service, job, result_part(job, "json", false)) + "}";
    }
    return json_response(200, std::move(text));
}

std::size_t body_bytes(const Request& request) {
    std::size_t bytes = 0;
    for (const http::BodyPart& part : request.body) bytes += part.bytes.size();
    return bytes;
}

Response submitted_response(Service& service, const Request& request, Submitted submitted) {
    JobRecord& job = submitted.job;
    auto wait = preferred_wait(request);
    // A large body would stay in memory, and in the share that all bodies have, while it waits.
    if (body_bytes(request) > most_waiting_body) wait.reset();
    if (wait && !is_final(job.state)) job = wait_for(service, request, std::move(job), *wait);
    Response response = wait && is_final(job.state) ? finished_response(service, job)
                                                    : job_response(service, job, 202);
    if (wait) response.headers.emplace_back("Preference-Applied", "wait=" + std::to_string(*wait));
    if (submitted.repeated) response.headers.emplace_back("Idempotent-Replayed", "true");
    response.headers.emplace_back("Location", "/v1/jobs/" + job.id);
    return response;
}

Response post_job(Service& service, const Request& request) {
    Submitted submitted = submit(service, request, read_submission(request), "", "");
    return submitted_response(service, request, std::move(submitted));
}

Response put_job(Service& service, const Request& request) {
    const std::string& id = request.captures.at(0);
    Submitted submitted = submit(service, request, read_submission(request), id, "");
    const bool repeated = submitted.repeated;
    Response response = submitted_response(service, request, std::move(submitted));
    if (repeated) response.status = 200;
    return response;
}

Response get_job(Service& service, const Request& request) {
    JobRecord job = found_job(service, request.principal, request.captures.at(0));
    const auto wait = preferred_wait(request);
    const bool waits = wait && !is_final(job.state);
    if (waits) job = wait_for(service, request, std::move(job), *wait);
    Response response = tagged(request, job_etag(service, job), job_response(service, job, 200));
    if (waits) response.headers.emplace_back("Preference-Applied", "wait=" + std::to_string(*wait));
    return response;
}

Response cancel_job(Service& service, const Request& request) {
    const std::string& id = request.captures.at(0);
    const auto state = service.jobs.cancel(request.principal, id);
    if (!state) (void)found_job(service, request.principal, id);
    if (state == JobState::succeeded || state == JobState::failed)
        refuse(409, "already_finished", "the job has already " + std::string(name(*state)));
    service.workers.cancel(id);
    service.watch.changed(id);
    const JobRecord job = found_job(service, request.principal, id);
    drop_unneeded(service.blobs, service.jobs, {job.model});
    return job_response(service, job, job.state == JobState::canceled ? 200 : 202);
}

Response remove_job(Service& service, const Request& request) {
    const std::string& id = request.captures.at(0);
    const auto blobs = service.jobs.remove(request.principal, id);
    if (!blobs) (void)found_job(service, request.principal, id);
    service.workers.cancel(id);
    service.watch.changed(id);
    drop_unneeded(service.blobs, service.jobs, *blobs);
    return empty_response(204);
}

/// Places in a list are the store's own; a signature keeps them from being made up, or used by
/// another key.
std::string cursor_code(const Service& service, const std::string& owner, std::string_view place) {
    return hmac_sha256(service.cursor_secret, owner + "\n" + std::string(place))
        .substr(0, code_bytes);
}

std::string cursor_of(Service& service, const std::string& owner, std::int64_t place) {
    const std::string text = std::to_string(place);
    return api::encode_base64url(cursor_code(service, owner, text) + text);
}

std::int64_t place_of(Service& service, const std::string& owner, const std::string& cursor) {
    const std::string bytes = api::decode_base64(cursor).value_or("");
    std::int64_t place = 0;
    if (bytes.size() > code_bytes) {
        const std::string_view text = std::string_view(bytes).substr(code_bytes);
        const auto read = std::from_chars(text.data(), text.data() + text.size(), place);
        if (read.ec == std::errc() && read.ptr == text.data() + text.size() &&
            equal_in_constant_time(bytes.substr(0, code_bytes),
                                   cursor_code(service, owner, text))) {
            return place;
        }
    }
    refuse(400, "cursor_invalid", "the cursor is not one that this list gave");
}

JobFilter filter_of(Service& service, const Request& request) {
    JobFilter filter;
    for (const auto& [name, value] : request.query) {
        if (name == "state") {
            filter.state = job_state_of(value);
            if (!filter.state)
                refuse(400, "parameter_invalid",
                       "state is one of queued, running, canceling, succeeded, failed, canceled");
        } else if (name == "tag") {
            filter.tag = value;
        } else if (name == "created_after") {
            filter.created_after_ms = api::rfc3339_ms(value);
            if (!filter.created_after_ms)
                refuse(400, "parameter_invalid",
                       "created_after is a time such as 2026-03-01T08:00:00Z");
        } else if (name == "limit") {
            std::size_t limit = 0;
            const auto read = std::from_chars(value.data(), value.data() + value.size(), limit);
            if (read.ec != std::errc() || read.ptr != value.data() + value.size() || limit < 1 ||
                limit > most_listed)
                refuse(400, "parameter_invalid",
                       "limit is a number from 1 to " + std::to_string(most_listed));
            filter.limit = limit;
        } else if (name == "cursor") {
            filter.before = place_of(service, request.principal, value);
        } else {
            refuse(400, "parameter_unknown",
                   "unknown parameter '" + name.substr(0, 40) +
                       "'; known are state, tag, created_after, limit, cursor");
        }
    }
    return filter;
}

Response list_jobs(Service& service, const Request& request) {
    const JobFilter filter = filter_of(service, request);
    const JobList jobs = service.jobs.list(request.principal, filter);
    std::string text = "{\"items\":[";
    for (const JobRecord& job : jobs.jobs) {
        if (text.back() == '}') text += ",";
        text += job_json(service, job);
    }
    text += "]";
    std::string link;
    if (jobs.next) {
        const std::string cursor = cursor_of(service, request.principal, *jobs.next);
        text += ",\"next_cursor\":\"" + cursor + "\"";
        link = "</v1/jobs?limit=" + std::to_string(filter.limit);
        for (const char* name : {"state", "tag", "created_after"}) {
            if (const auto value = request.query.find(name); value != request.query.end())
                link += "&" + std::string(name) + "=" + http::percent_encoded(value->second);
        }
        link += "&cursor=" + cursor + ">; rel=\"next\"";
    }
    Response response = json_response(200, text + "}");
    if (!link.empty()) response.headers.emplace_back("Link", link);
    return response;
}

}  // namespace

std::vector<http::Route> job_routes(Service& service) {
    const auto route = [&](const char* method, const char* pattern,
                           Response (*handle)(Service&, const Request&), bool takes_body = false) {
        return http::Route{method, pattern, guarded([&service, handle](const Request& request) {
                               return handle(service, request);
                           }),
                           takes_body};
    };
    return {route("POST", "/v1/jobs", post_job, true),
            route("GET", "/v1/jobs", list_jobs),
            route("PUT", "/v1/jobs/{id}", put_job, true),
            route("GET", "/v1/jobs/{id}", get_job),
            route("DELETE", "/v1/jobs/{id}", remove_job),
            route("POST", "/v1/jobs/{id}/cancel", cancel_job)};
}

}  // namespace lastflat::server
