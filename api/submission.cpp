#include "api/submission.h"

#include "api/base64.h"
#include "api/object_reader.h"
#include "core/load/first_bytes.h"

namespace lastflat::api {

JsonSubmission read_json_submission(const Field& field, const RequestLimits& limits) {
    ObjectReader reader(field);
    JsonSubmission submission;
    const auto model = reader.find("model");
    if (!model) {
        throw InvalidRequest(field.pointer + "/model",
                             "must be given: {\"data\": base64} or {\"asset_id\": id}");
    }
    ObjectReader inner(*model);
    const auto data = inner.find("data"), asset = inner.find("asset_id");
    inner.finish();
    if (data.has_value() == asset.has_value())
        model->fail("must have \"data\", the model in base64, or \"asset_id\", not both");
    if (asset) submission.asset_id = asset->text(limits.name_bytes);
    if (data) {
        if (!data->value.is_string()) data->fail("must be text, the model in base64");
        auto bytes = decode_base64(data->value.get_ref<const std::string&>());
        if (!bytes) data->fail("is not base64");
        submission.model = std::move(*bytes);
    }
    if (const auto request = reader.find("request")) {
        submission.request = read_flatten_request(*request, limits);
        submission.request_text = request->value.dump();
        if (submission.request_text.size() > limits.bytes)
            request->fail("has more than " + std::to_string(limits.bytes) + " bytes");
    }
    if (const auto webhook = reader.find("webhook"))
        submission.webhook = read_webhook(*webhook, WebhookScope::job);
    if (const auto priority = reader.find("priority"))
        submission.priority = priority->choice(job_priorities);
    reader.finish();
    return submission;
}

JsonSubmission json_submission_from_json(std::string_view text, const RequestLimits& limits) {
    const nlohmann::json document = parse_json(text, limits.depth + 1);
    return read_json_submission({document, ""}, limits);
}

void check_model_bytes(std::string_view model) {
    check_first_bytes(model);
}

}  // namespace lastflat::api
