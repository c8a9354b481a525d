#include "server/routes/submit_routes.h"

#include "server/jobs/result_parts.h"
#include "server/routes/answers.h"
#include "server/routes/submission.h"

namespace lastflat::server {
namespace {

using http::Request;
using http::Response;

/// The job with its result inside.
Response finished_response(const SubmitServices& service, const JobRecord& job) {
    const api::Job view = service.view.of(job);
    if (job.state != JobState::succeeded || job.result.empty())
        return json_response(200, to_json(view));
    return json_response(200,
                         to_json(view, result_bytes(service.blobs, job, result_part(job, "json"))));
}

Response submitted_response(const SubmitServices& service, const Request& request,
                            Submitted submitted) {
    JobRecord& job = submitted.job;
    const auto wait = preferred_wait(request);
    if (wait && !is_final(job.state)) job = service.wait.wait(request, std::move(job), *wait);
    Response response = wait && is_final(job.state) ? finished_response(service, job)
                                                    : job_response(service.view, job, 202);
    if (wait) response.headers.emplace_back("Preference-Applied", "wait=" + std::to_string(*wait));
    if (submitted.repeated) response.headers.emplace_back("Idempotent-Replayed", "true");
    response.headers.emplace_back("Location", "/v1/jobs/" + job.id);
    return response;
}

/// What is asked for and how; `id`: chosen by the client, else empty.
Submission job_asked_by(const Request& request, const std::string& id) {
    Submission submission = read_submission(request);
    read_terms(request, submission);
    submission.id = id;
    return submission;
}

Response post_job(const SubmitServices& service, const Request& request) {
    Submitted submitted = service.intake.submit(job_asked_by(request, ""));
    return submitted_response(service, request, std::move(submitted));
}

Response put_job(const SubmitServices& service, const Request& request) {
    Submitted submitted = service.intake.submit(job_asked_by(request, request.captures.at(0)));
    const bool repeated = submitted.repeated;
    Response response = submitted_response(service, request, std::move(submitted));
    if (repeated) response.status = 200;
    return response;
}

}  // namespace

std::vector<http::Route> submit_routes(const SubmitServices& service) {
    return {{"POST",
             "/v1/jobs",
             [service](const Request& request) { return post_job(service, request); },
             true,
             false,
             {"asset_id"}},
            {"PUT",
             "/v1/jobs/{id}",
             [service](const Request& request) { return put_job(service, request); },
             true,
             false,
             {"asset_id"}}};
}

}  // namespace lastflat::server
