#include "api/batch.h"

#include "api/json.h"
#include "api/object_reader.h"
#include "api/timestamp.h"

namespace lastflat::api {
namespace {

constexpr int deepest_batch = 14;

}  // namespace

BatchRequest::BatchRequest(std::string_view text) : document_(parse_json(text, deepest_batch)) {
    ObjectReader reader({document_, ""});
    const auto jobs = reader.find("jobs");
    reader.finish();
    if (!jobs) throw InvalidRequest("/jobs", "must be given: a list of jobs");
    if (jobs->items(most_batch_jobs).empty()) jobs->fail("must have at least one job");
}

std::size_t BatchRequest::size() const {
    return document_["jobs"].size();
}

JsonSubmission BatchRequest::job(std::size_t index) const {
    return read_json_submission({document_["jobs"][index], "/jobs/" + std::to_string(index)});
}

std::string to_json(const Batch& batch) {
    const std::string self = "/v1/batches/" + batch.id;
    Json json{{"id", batch.id},
              {"created_at", rfc3339(batch.created_ms)},
              {"finished", batch.finished_ms.has_value()}};
    if (batch.finished_ms) json["finished_at"] = rfc3339(*batch.finished_ms);
    json["size"] = batch.size;
    json["states"] = counts_json(batch.states);
    json["items"] = json_of(batch.items);
    json["links"] = {{"self", self},
                     {"table", self + "/results.csv"},
                     {"archive", self + "/result.zip"},
                     {"events", self + "/events"},
                     {"cancel", self + "/cancel"}};
    return text_of(json);
}

}  // namespace lastflat::api
