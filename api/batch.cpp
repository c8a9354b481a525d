#include "api/batch.h"

#include <algorithm>

#include "api/json.h"
#include "api/object_reader.h"

namespace lastflat::api {
namespace {

constexpr int deepest_batch = 14;

Json json_of(const Batch::Item& item) {
    const bool is_taken = std::holds_alternative<Job>(item.outcome);
    return {{"status", item.status},
            {is_taken ? "job" : "problem",
             std::visit([](const auto& outcome) { return api::json_of(outcome); }, item.outcome)}};
}

}  // namespace

BatchRequest::BatchRequest(std::string_view text) : document_(parse_json(text, deepest_batch)) {
    ObjectReader reader({document_, ""});
    const auto jobs = reader.find("jobs");
    reader.finish();
    if (!jobs) throw InvalidRequest("/jobs", "must be given: a list of jobs");
    (void)jobs->items(most_batch_jobs);
}

std::size_t BatchRequest::size() const {
    return document_["jobs"].size();
}

JsonSubmission BatchRequest::job(std::size_t index) const {
    return read_json_submission({document_["jobs"][index], ""});
}

std::string to_json(const Batch& batch) {
    Json items = Json::array();
    for (const Batch::Item& item : batch.items) items.push_back(json_of(item));
    const auto taken = std::count_if(batch.items.begin(), batch.items.end(), [](const auto& item) {
        return std::holds_alternative<Job>(item.outcome);
    });
    return text_of({{"id", batch.id},
                    {"taken", taken},
                    {"refused", batch.items.size() - static_cast<std::size_t>(taken)},
                    {"items", std::move(items)},
                    {"links", {{"self", "/v1/batches/" + batch.id}}}});
}

std::string to_json(const BatchState& batch) {
    Json counts = Json::object();
    bool finished = true;
    for (const Job& job : batch.items) {
        const std::string state(word_of(job_states, job.state));
        counts[state] = counts.value(state, 0) + 1;
        finished = finished && is_final(job.state);
    }
    return text_of({{"id", batch.id},
                    {"finished", finished},
                    {"states", std::move(counts)},
                    {"items", json_of(batch.items)}});
}

}  // namespace lastflat::api
