#include "server/routes/batch_routes.h"

#include "api/batch.h"
#include "api/refusal.h"
#include "server/routes/answers.h"
#include "server/routes/submission.h"
#include "server/support/large_body_turn.h"

namespace lastflat::server {
namespace {

using http::Request;
using http::Response;

/// The batch; with Retry-After while it has not finished.
Response batch_response(const BatchView& view, const BatchRecord& batch, int status) {
    Response response = json_response(status, view.json(batch));
    if (!batch.finished_ms) response.headers.emplace_back("Retry-After", "1");
    return response;
}

/// After the wait that the client prefers, if it does.
Response awaited(const BatchView& view, const Request& request, BatchRecord batch,
                 int status_while_it_runs) {
    const auto wait = preferred_wait(request);
    if (wait && !batch.finished_ms) batch = view.wait(request, std::move(batch), *wait);
    Response response = batch_response(view, batch, batch.finished_ms ? 200 : status_while_it_runs);
    if (wait) response.headers.emplace_back("Preference-Applied", "wait=" + std::to_string(*wait));
    return response;
}

SubmittedBatch submit(const BatchServices& service, const Request& request) {
    const api::BatchRequest jobs = [&] {
        const LargeBodyTurn turn(request.principal, request.body.front().bytes.size());
        return api::BatchRequest(request.body.front().bytes);
    }();
    Submission terms;
    read_terms(request, terms);
    BatchSubmission batch{terms.owner, terms.idempotency_key, jobs.size(), {}};
    batch.submission = [&](std::size_t index) {
        Submission submission = submission_of(jobs.job(index), "/jobs/" + std::to_string(index));
        check_scope(request, submission);
        submission.cancel_after = terms.cancel_after;
        submission.fresh = terms.fresh;
        if (!submission.priority) submission.priority = terms.priority;
        return submission;
    };
    return service.intake.submit(batch);
}

Response post_batch(const BatchServices& service, const Request& request) {
    if (request.body.empty() || request.body.front().media_type != "application/json")
        api::refuse("media_type_unsupported", "a batch is sent as application/json");
    const SubmittedBatch submitted = submit(service, request);
    Response response =
        awaited(service.view, request, service.view.found(request, submitted.id), 202);
    if (submitted.repeated) response.headers.emplace_back("Idempotent-Replayed", "true");
    response.headers.emplace_back("Location", "/v1/batches/" + submitted.id);
    return response;
}

Response get_batch(const BatchServices& service, const Request& request) {
    return awaited(service.view, request, service.view.found(request, request.captures.at(0)), 200);
}

Response cancel_batch(const BatchServices& service, const Request& request) {
    const BatchRecord batch = service.view.found(request, request.captures.at(0));
    if (batch.finished_ms) api::refuse("already_finished", "all jobs of the batch have ended");
    for (const JobRecord& job : service.view.jobs_of(batch)) {
        if (is_final(job.state)) continue;
        try {
            (void)service.control.cancel(request.principal, job.id);
        } catch (const api::Refusal& refusal) {
            // It has ended or was deleted meanwhile.
            if (refusal.problem().status >= 500) throw;
        }
    }
    const BatchRecord after = service.view.found(request, batch.id);
    return batch_response(service.view, after, after.finished_ms ? 200 : 202);
}

}  // namespace

std::vector<http::Route> batch_routes(const BatchServices& service) {
    return {{"POST", "/v1/jobs:batch",
             [service](const Request& request) { return post_batch(service, request); }, true},
            {"GET", "/v1/batches/{id}",
             [service](const Request& request) { return get_batch(service, request); }},
            {"POST", "/v1/batches/{id}/cancel",
             [service](const Request& request) { return cancel_batch(service, request); }}};
}

}  // namespace lastflat::server
