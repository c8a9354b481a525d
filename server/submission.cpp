#include "server/submission.h"

#include <algorithm>
#include <thread>

#include "api/base64.h"
#include "api/flatten_request.h"
#include "server/translate.h"

namespace lastflat::server {
namespace {

[[noreturn]] void refuse(int status, const char* code, const std::string& detail) {
    throw Refusal({status, code, "", detail, std::nullopt, std::nullopt});
}

JobInput job_input(std::string model, const api::FlattenRequest& request) {
    if (model.empty()) refuse(422, "model_missing", "the model is empty (0 bytes)");
    JobInput input{std::make_shared<const std::string>(std::move(model)), to_options(request),
                   request.tag};
    input.options.threads = std::max(1u, std::thread::hardware_concurrency());
    return input;
}

JobInput from_parts(const http::Request& request) {
    const http::BodyPart* model = nullptr;
    const http::BodyPart* constraints = nullptr;
    for (const http::BodyPart& part : request.body) {
        const auto take = [&](const http::BodyPart*& place) {
            if (place != nullptr)
                refuse(400, "part_repeated", "the part '" + part.name + "' is there twice");
            place = &part;
        };
        if (part.name == "model")
            take(model);
        else if (part.name == "request")
            take(constraints);
        else
            refuse(400, "part_unknown",
                   "unknown part '" + part.name + "'; known are model and request");
    }
    if (model == nullptr)
        refuse(422, "model_missing", "the part 'model' is missing: send the last's file as it");
    return job_input(model->bytes,
                     api::flatten_request_from_json(constraints ? constraints->bytes : ""));
}

JobInput from_model_alone(const http::Request& request) {
    const std::string_view header = request.header("x-flatten-constraints");
    const auto constraints = api::decode_base64(header);
    if (!constraints) {
        refuse(400, "header_invalid", "X-Flatten-Constraints is not base64url");
    }
    return job_input(request.body.empty() ? "" : request.body.front().bytes,
                     api::flatten_request_from_json(*constraints));
}

bool is_form(const http::Request& request) {
    constexpr std::string_view form = "multipart/form-data";
    const std::string_view type = request.header("content-type").substr(0, form.size());
    return std::equal(type.begin(), type.end(), form.begin(), form.end(),
                      [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a + 32 : a) == b; });
}

}  // namespace

JobInput read_submission(const http::Request& request) {
    if (is_form(request)) return from_parts(request);
    if (!request.body.empty() && request.body.front().media_type == "application/json") {
        auto submission = api::json_submission_from_json(request.body.front().bytes);
        return job_input(std::move(submission.model), submission.request);
    }
    return from_model_alone(request);
}

}  // namespace lastflat::server
