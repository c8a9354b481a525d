#include "server/routes/validate_route.h"

#include "api/refusal.h"
#include "server/routes/answers.h"
#include "server/routes/submission.h"

namespace lastflat::server {
namespace {

http::Response validate(const ValidateServices& service, const http::Request& request) {
    if (service.draining) api::refuse("draining", "the service is ending; try again later");
    Submission submission = read_submission_with_model(request, service.assets, service.blobs);
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
