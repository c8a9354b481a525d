#include "server/routes/batch_routes.h"

#include <nlohmann/json.hpp>

#include "api/object_reader.h"
#include "api/problem_json.h"
#include "server/routes/answers.h"
#include "server/routes/submission.h"
#include "server/worker/problem_map.h"

namespace lastflat::server {
namespace {

using http::Request;
using http::Response;
using Json = nlohmann::ordered_json;

constexpr std::size_t most_jobs = 200;
constexpr int deepest_batch = 14;

/// One job's own success or failure: a batch is taken in part.
Json item(int status, Json content) {
    return {{"status", status}, {status < 300 ? "job" : "problem", std::move(content)}};
}

Json refused(const api::Problem& problem) {
    return item(problem.status, api::problem_json(problem));
}

Json submit_one(const BatchServices& service, const Request& request, const nlohmann::json& job,
                std::string& batch) {
    try {
        Submission submission = read_json_submission(job.dump());
        read_terms(request, submission);
        submission.batch = batch;
        const Submitted submitted = service.intake.submit(submission);
        if (submitted.repeated) batch = submitted.job.batch;
        return item(submitted.repeated ? 200 : 202, Json::parse(service.view.json(submitted.job)));
    } catch (const Refusal& refusal) {
        return refused(refusal.problem());
    } catch (const api::InvalidRequest& invalid) {
        return refused(problem_of(invalid));
    } catch (const Error& error) {
        return refused(problem_of(error));
    } catch (const StoreError&) {
        return refused(store_unavailable());  // those before it are taken all the same
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
        refuse(415, "media_type_unsupported", "a batch is sent as application/json");
    const auto document = api::parse_json(request.body.front().bytes, deepest_batch);
    api::ObjectReader reader(api::Field{document, ""});
    const auto jobs = reader.find("jobs");
    reader.finish();
    if (!jobs) throw api::InvalidRequest("/jobs", "must be given: a list of jobs");
    std::string batch = new_job_id();
    Json items = Json::array();
    std::size_t taken = 0;
    ItemRequest item_request(request);
    for (const api::Field& job : jobs->items(most_jobs)) {
        items.push_back(submit_one(service, item_request.of(items.size()), job.value, batch));
        taken += items.back().contains("job") ? 1 : 0;
    }
    const std::string self = "/v1/batches/" + batch;
    const Json answer{{"id", batch},
                      {"taken", taken},
                      {"refused", items.size() - taken},
                      {"items", std::move(items)},
                      {"links", {{"self", self}}}};
    Response response = json_response(202, answer.dump());
    response.headers.emplace_back("Location", self);
    return response;
}

Response get_batch(const BatchServices& service, const Request& request) {
    const std::string& id = request.captures.at(0);
    JobFilter filter;
    filter.batch = id;
    filter.limit = most_jobs;
    const JobList list = service.jobs.list(request.principal, filter);
    if (list.jobs.empty())
        refuse(404, "batch_not_found", "there is no batch " + id + ", or none of its jobs is left");
    Json items = Json::array();
    Json counts = Json::object();
    bool finished = true;
    for (auto job = list.jobs.rbegin(); job != list.jobs.rend(); ++job) {
        items.push_back(Json::parse(service.view.json(*job)));
        const std::string state(name(job->state));
        counts[state] = counts.value(state, 0) + 1;
        finished = finished && is_final(job->state);
    }
    const Json answer{{"id", id},
                      {"finished", finished},
                      {"states", std::move(counts)},
                      {"items", std::move(items)}};
    return json_response(200, answer.dump());
}

}  // namespace

std::vector<http::Route> batch_routes(const BatchServices& service) {
    return {
        {"POST", "/v1/jobs:batch",
         guarded([service](const Request& request) { return post_batch(service, request); }), true},
        {"GET", "/v1/batches/{id}",
         guarded([service](const Request& request) { return get_batch(service, request); })}};
}

}  // namespace lastflat::server
