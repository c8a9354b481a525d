#include "server/routes/validate_route.h"

#include "api/refusal.h"
#include "server/routes/answers.h"
#include "server/routes/submission.h"

namespace lastflat::server {
namespace {

http::Response validate(const ValidateServices& service, const http::Request& request) {
    if (service.draining) api::refuse("draining", "the service is ending; try again later");
    Submission submission = read_submission(request);
    if (!submission.asset.empty()) {
        if (!service.assets.find(request.principal, submission.asset))
            throw api::Refusal("asset_not_found",
                               "there is no asset " + submission.asset.substr(0, 80))
                .in_content();
        submission.make_model(service.blobs.read(submission.asset));
    }
    return json_response(
        200, service.tasks.report(request, Task::inspect, submission.model, submission.request));
}

}  // namespace

http::Route validate_route(const ValidateServices& service) {
    return {"POST",
            "/v1/validate",
            [service](const http::Request& request) { return validate(service, request); },
            true,
            false,
            {"asset_id"}};
}

}  // namespace lastflat::server
