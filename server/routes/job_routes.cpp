#include "server/routes/job_routes.h"

#include "server/routes/answers.h"

namespace lastflat::server {
namespace {

using http::Request;
using http::Response;

Response get_job(const JobServices& service, const Request& request) {
    JobRecord job = found_job(service.jobs, request.principal, request.captures.at(0));
    const auto wait = preferred_wait(request);
    const bool waits = wait && !is_final(job.state);
    if (waits) job = service.wait.wait(request, std::move(job), *wait);
    Response response =
        tagged(request, service.view.etag(job), job_response(service.view, job, 200));
    if (waits) response.headers.emplace_back("Preference-Applied", "wait=" + std::to_string(*wait));
    return response;
}

Response cancel_job(const JobServices& service, const Request& request) {
    const JobRecord job = service.control.cancel(request.principal, request.captures.at(0));
    return job_response(service.view, job, job.state == JobState::canceled ? 200 : 202);
}

Response remove_job(const JobServices& service, const Request& request) {
    service.control.remove(request.principal, request.captures.at(0));
    return empty_response(204);
}

}  // namespace

std::vector<http::Route> job_routes(const JobServices& service) {
    return {{"GET", "/v1/jobs/{id}",
             [service](const Request& request) { return get_job(service, request); }},
            {"DELETE", "/v1/jobs/{id}",
             [service](const Request& request) { return remove_job(service, request); }},
            {"POST", "/v1/jobs/{id}/cancel",
             [service](const Request& request) { return cancel_job(service, request); }}};
}

}  // namespace lastflat::server
