#include "server/routes/submission.h"

#include <algorithm>

#include "api/base64.h"
#include "api/flatten_request.h"
#include "api/object_reader.h"
#include "api/refusal.h"
#include "server/routes/side_files.h"
#include "server/support/duration.h"
#include "server/support/large_body_turn.h"
#include "server/webhooks/post_message.h"

namespace lastflat::server {
namespace {

constexpr std::size_t longest_key = 255;

/// Everything that can be found wrong without the model's geometry is found here.
Submission checked(Submission submission, const api::FlattenRequest& request) {
    if (submission.model.empty() && submission.asset.empty())
        api::refuse("model_missing", "the model is empty (0 bytes)");
    if (submission.asset.empty()) api::check_model_bytes(submission.model);
    submission.tag = request.tag;
    return submission;
}

Submission checked(Submission submission, const std::string& owner) {
    const LargeBodyTurn turn(owner, submission.request.size());
    const auto request = api::flatten_request_from_json(submission.request);
    return checked(std::move(submission), request);
}

Submission from_parts(const http::Request& request) {
    const http::BodyPart *model = nullptr, *asset = nullptr, *constraints = nullptr,
                         *material = nullptr;
    std::vector<const http::BodyPart*> buffers;
    for (const http::BodyPart& part : request.body) {
        const auto take = [&](const http::BodyPart*& slot) {
            if (slot != nullptr)
                api::refuse("part_repeated", "the part '" + part.name + "' is there twice");
            slot = &part;
        };
        if (part.name == "model")
            take(model);
        else if (part.name == "asset_id")
            take(asset);
        else if (part.name == "request")
            take(constraints);
        else if (part.name == "mtl")
            take(material);  // its names stand in the OBJ; what they look like does not matter here
        else if (part.name == "buffers")
            buffers.push_back(&part);
        else
            api::refuse("part_unknown",
                        "unknown part '" + part.name +
                            "'; known are model, buffers, mtl, asset_id and request");
    }
    if ((model == nullptr) == (asset == nullptr))
        api::refuse(
            "model_missing",
            "send either the part 'model', the last's file, or 'asset_id', an uploaded one");
    Submission submission;
    if (!buffers.empty() && model == nullptr)
        api::refuse("part_unused", "an asset is one file: it has no buffers beside it");
    if (model != nullptr) submission.model = model->bytes;
    if (!buffers.empty())
        submission.make_model(with_buffers_inside(model->bytes, buffers, request.principal));
    if (asset != nullptr) submission.asset = asset->bytes;
    if (constraints != nullptr) submission.request = constraints->bytes;
    return checked(std::move(submission), request.principal);
}

Submission from_model_alone(const http::Request& request) {
    const auto constraints = api::decode_base64(request.header("x-flatten-constraints"));
    if (!constraints) api::refuse("header_invalid", "X-Flatten-Constraints is not base64url");
    Submission submission;
    if (const auto asset = request.query.find("asset_id"); asset != request.query.end())
        submission.asset = asset->second;
    if (!request.body.empty()) submission.model = request.body.front().bytes;
    if (!submission.asset.empty() && !submission.model.empty())
        api::refuse("model_repeated", "there is a model in the body beside ?asset_id=; send one");
    submission.request = *constraints;
    return checked(std::move(submission), request.principal);
}

bool is_form(const http::Request& request) {
    constexpr std::string_view form = "multipart/form-data";
    const std::string_view type = request.header("content-type").substr(0, form.size());
    return std::equal(type.begin(), type.end(), form.begin(), form.end(),
                      [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a + 32 : a) == b; });
}

Submission read_any_submission(const http::Request& request) {
    if (is_form(request)) return from_parts(request);
    if (!request.body.empty() && request.body.front().media_type == "application/json") {
        const LargeBodyTurn turn(request.principal, request.body.front().bytes.size());
        return submission_of(api::json_submission_from_json(request.body.front().bytes));
    }
    return from_model_alone(request);
}

/// The key of a request; quoted as the draft has it, or bare.
std::string idempotency_key(const http::Request& request) {
    std::string_view key = request.header("idempotency-key");
    if (key.size() >= 2 && key.front() == '"' && key.back() == '"')
        key = key.substr(1, key.size() - 2);
    if (key.empty() && request.headers.contains("idempotency-key"))
        api::refuse("header_invalid", "Idempotency-Key is empty");
    if (key.size() > longest_key)
        api::refuse("header_invalid",
                    "Idempotency-Key has more than " + std::to_string(longest_key) + " bytes");
    return std::string(key);
}

}  // namespace

Submission read_submission_with_model(const http::Request& request, AssetStore& assets,
                                      const BlobStore& blobs) {
    Submission submission = read_submission(request);
    if (submission.asset.empty()) return submission;
    if (!assets.find(request.principal, submission.asset))
        throw api::Refusal("asset_not_found", "there is no asset " + submission.asset.substr(0, 80))
            .in_content();
    submission.make_model(blobs.read(submission.asset));
    return submission;
}

Submission submission_of(api::JsonSubmission json, const std::string& pointer) {
    Submission submission;
    submission.make_model(std::move(json.model));
    submission.asset = std::move(json.asset_id);
    submission.request = std::move(json.request_text);
    if (json.webhook && !is_webhook_url(json.webhook->url))
        throw api::InvalidRequest(pointer + "/webhook/url", not_a_webhook_url);
    submission.priority = json.priority;
    submission.webhook = std::move(json.webhook);
    return checked(std::move(submission), json.request);
}

void check_scope(const http::Request& request, const Submission& submission) {
    if (!request.restriction.empty() && submission.asset != request.restriction)
        api::refuse("scope_refused", "this token is for the asset " + request.restriction);
    if (request.is_limited && submission.webhook)
        api::refuse("scope_refused", "a webhook needs a key of scope 'all'");
}

Submission read_submission(const http::Request& request) {
    Submission submission = read_any_submission(request);
    check_scope(request, submission);
    return submission;
}

void read_terms(const http::Request& request, Submission& submission) {
    submission.owner = request.principal;
    submission.idempotency_key = idempotency_key(request);
    submission.cancel_after = request.header("cancel-after");
    if (!submission.cancel_after.empty() && !duration_ms(submission.cancel_after))
        api::refuse("header_invalid", "Cancel-After is not a duration such as 90s, 2m or 1h");
    submission.fresh = request.header("cache-control").find("no-cache") != std::string_view::npos;
    if (submission.priority || !request.headers.contains("job-priority")) return;
    const auto priority = api::value_of(api::job_priorities, request.header("job-priority"));
    if (!priority)
        api::refuse("header_invalid", "Job-Priority is one of " + api::listed(api::job_priorities));
    submission.priority = *priority;
}

}  // namespace lastflat::server
