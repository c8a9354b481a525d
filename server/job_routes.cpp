#include "server/job_routes.h"

#include "api/job.h"
#include "server/openapi.h"
#include "server/problem_map.h"
#include "server/result_format.h"
#include "server/submission.h"
#include "server/version.h"

namespace lastflat::server {
namespace {

http::Response json_response(int status, std::string body) {
    http::Response response;
    response.status = status;
    response.media_type = "application/json";
    response.body = std::make_shared<const std::string>(std::move(body));
    response.headers.emplace_back("Cache-Control", "no-store");
    return response;
}

[[noreturn]] void refuse(int status, const char* code, const std::string& detail) {
    throw Refusal({status, code, "", detail, std::nullopt, std::nullopt});
}

/// Turns what a handler throws into its answer: the only catch of the handlers.
http::Handler guarded(http::Handler handler) {
    return [handler = std::move(handler)](const http::Request& request) {
        try {
            return handler(request);
        } catch (const Refusal& refusal) {
            return problem_response(refusal.problem());
        } catch (const api::InvalidRequest& invalid) {
            return problem_response(problem_of(invalid));
        } catch (const Error& error) {
            return problem_response(problem_of(error));
        }
    };
}

class JobApi {
public:
    JobApi(JobStore& store, WorkerPool& workers) : store_(store), workers_(workers) {}

    http::Response post(const http::Request& request) const {
        const std::string id = new_job_id();
        if (!store_.add(id, read_submission(request))) {
            refuse(503, "queue_full", "the queue is full; try again in a few seconds");
        }
        workers_.wake();
        http::Response response = json_response(202, job_json(found(id)));
        response.headers.emplace_back("Location", "/v1/jobs/" + id);
        response.headers.emplace_back("Retry-After", "1");
        return response;
    }

    http::Response get(const http::Request& request) const {
        const JobRecord job = found(request.captures.at(0));
        http::Response response = json_response(200, job_json(job));
        if (!is_final(job.state)) response.headers.emplace_back("Retry-After", "1");
        return response;
    }

    http::Response get_result(const http::Request& request) const {
        const ResultFormat format = negotiated_format(request);
        const JobRecord job = found(request.captures.at(0));
        switch (job.state) {
            case JobState::succeeded: break;
            case JobState::failed: {
                api::Problem problem = job.error.value();
                problem.status = 409;
                problem.detail = "the job failed: " + problem.detail;
                throw Refusal(problem);
            }
            case JobState::canceled:
                refuse(409, "canceled", "the job was canceled; it has no result");
            case JobState::queued:
            case JobState::running:
            case JobState::canceling:
                refuse(409, "not_finished",
                       "the job is " + std::string(name(job.state)) + "; ask again later");
        }
        if (!job.output)
            refuse(410, "result_expired",
                   "the result has been dropped to make room; post the job again");
        http::Response response;
        response.media_type = media_type(format);
        response.body = bytes_of(*job.output, format);
        response.headers.emplace_back("Vary", "Accept");
        response.headers.emplace_back("Content-Disposition",
                                      "inline; filename=\"" + job.id + file_ending(format) + "\"");
        return response;
    }

    http::Response cancel(const http::Request& request) const {
        const std::string& id = request.captures.at(0);
        const auto state = store_.cancel(id);
        if (!state) fail_not_found(id);
        workers_.cancel(id);
        if (*state == JobState::succeeded || *state == JobState::failed) {
            refuse(409, "already_finished", "the job has already " + std::string(name(*state)));
        }
        return json_response(*state == JobState::canceling ? 202 : 200, job_json(found(id)));
    }

    http::Response remove(const http::Request& request) const {
        const std::string& id = request.captures.at(0);
        workers_.cancel(id);
        if (!store_.remove(id)) fail_not_found(id);
        http::Response response;
        response.status = 204;
        return response;
    }

    http::Response health() const {
        const JobCounts counts = store_.counts();
        return json_response(200, "{\"status\":\"ok\",\"version\":\"" + std::string(version) +
                                      "\",\"jobs\":{\"queued\":" + std::to_string(counts.queued) +
                                      ",\"running\":" + std::to_string(counts.running) + "}}");
    }

private:
    [[noreturn]] static void fail_not_found(const std::string& id) {
        refuse(404, "job_not_found",
               "there is no job " + id + "; it may have been deleted or forgotten");
    }

    JobRecord found(const std::string& id) const {
        auto job = store_.find(id);
        if (!job) fail_not_found(id);
        return std::move(*job);
    }

    std::string job_json(const JobRecord& record) const {
        api::Job job;
        job.id = record.id;
        job.state = name(record.state);
        job.tag = record.tag;
        job.created_ms = record.created_ms;
        job.started_ms = record.started_ms;
        job.finished_ms = record.finished_ms;
        job.queue_position = record.queue_position;
        job.error = record.error;
        job.stage = job.state;
        if (record.state == JobState::succeeded) job.percent = 100;
        if (const auto progress = workers_.progress(record.id);
            progress && !is_final(record.state)) {
            job.stage = name(progress->first);
            job.percent = static_cast<int>(100.0 * progress->second);
        }
        return api::to_json(job);
    }

    JobStore& store_;
    WorkerPool& workers_;
};

}  // namespace

http::Response problem_response(const api::Problem& problem) {
    http::Response response = json_response(problem.status, api::to_json(problem));
    response.media_type = "application/problem+json";
    const bool later =
        problem.status == 503 || problem.status == 429 || problem.code == "not_finished";
    if (later)
        response.headers.emplace_back("Retry-After", problem.code == "not_finished" ? "1" : "5");
    return response;
}

std::vector<http::Route> job_routes(JobStore& store, WorkerPool& workers) {
    const JobApi jobs(store, workers);
    const auto contract = [](const http::Request&) { return json_response(200, openapi_json); };
    using http::Request;
    return {
        {"POST", "/v1/jobs", guarded([=](const Request& r) { return jobs.post(r); }), true, false},
        {"GET", "/v1/jobs/{id}", guarded([=](const Request& r) { return jobs.get(r); })},
        {"DELETE", "/v1/jobs/{id}", guarded([=](const Request& r) { return jobs.remove(r); })},
        {"GET", "/v1/jobs/{id}/result",
         guarded([=](const Request& r) { return jobs.get_result(r); })},
        {"POST", "/v1/jobs/{id}/cancel", guarded([=](const Request& r) { return jobs.cancel(r); })},
        {"GET", "/healthz", [=](const Request&) { return jobs.health(); }, false, true},
        {"GET", "/openapi.json", contract},
    };
}

}  // namespace lastflat::server
