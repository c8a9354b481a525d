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

/// One job's own success or failure: a batch is taken in part. `batch`: its id, which is that of
/// the first time if the batch is sent again.
api::Batch::Item submit_one(const BatchServices& service, const Request& request,
                            const api::BatchRequest& jobs, std::size_t index, std::string& batch) {
    try {
        Submission submission = submission_of(jobs.job(index));
        read_terms(request, submission);
        submission.batch = batch;
        const Submitted submitted = service.intake.submit(submission);
        if (submitted.repeated) batch = submitted.job.batch;
        return {submitted.repeated ? 200 : 202, service.view.of(submitted.job)};
    } catch (...) {
        api::Problem problem = refusal_to(request, std::current_exception()).problem();
        return {problem.status, std::move(problem)};
    }
}

/// The request without its body, as that of an item: its key, if it has one, is the item's own.
class ItemRequest {
public:
    explicit ItemRequest(const Request& whole) : key_(whole.header("idempotency-key")) {
        request_.id = whole.id;
        request_.headers = whole.headers;
        request_.principal = whole.principal;
    }
    const Request& of(std::size_t index) {
        if (!key_.empty()) request_.headers["idempotency-key"] = key_ + "/" + std::to_string(index);
        return request_;
    }

private:
    Request request_;
    const std::string key_;
};

Response post_batch(const BatchServices& service, const Request& request) {
    if (request.body.empty() || request.body.front().media_type != "application/json")
        api::refuse("media_type_unsupported", "a batch is sent as application/json");
    const api::BatchRequest jobs = [&] {
        const LargeBodyTurn turn(request.body.front().bytes.size());
        return api::BatchRequest(request.body.front().bytes);
    }();
    api::Batch batch{new_job_id(), {}};
    ItemRequest item_request(request);
    for (std::size_t i = 0; i < jobs.size(); ++i)
        batch.items.push_back(submit_one(service, item_request.of(i), jobs, i, batch.id));
    Response response = json_response(202, to_json(batch));
    response.headers.emplace_back("Location", "/v1/batches/" + batch.id);
    return response;
}

Response get_batch(const BatchServices& service, const Request& request) {
    const std::string& id = request.captures.at(0);
    JobFilter filter;
    filter.batch = id;
    filter.limit = api::most_batch_jobs;
    const JobList list = service.jobs.list(request.principal, filter);
    if (list.jobs.empty())
        api::refuse("batch_not_found", "there is no batch " + id + ", or none of its jobs is left");
    api::BatchState batch{id, {}};
    for (auto job = list.jobs.rbegin(); job != list.jobs.rend(); ++job)
        batch.items.push_back(service.view.of(*job));
    return json_response(200, to_json(batch));
}

}  // namespace

std::vector<http::Route> batch_routes(const BatchServices& service) {
    return {{"POST", "/v1/jobs:batch",
             [service](const Request& request) { return post_batch(service, request); }, true},
            {"GET", "/v1/batches/{id}",
             [service](const Request& request) { return get_batch(service, request); }}};
}

}  // namespace lastflat::server
