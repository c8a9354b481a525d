#include "server/routes/validate_route.h"

#include "server/routes/answers.h"
#include "server/routes/submission.h"

namespace lastflat::server {
namespace {

http::Response validate(const ValidateServices& service, const http::Request& request) {
    if (service.draining) refuse(503, "draining", "the service is ending; try again later");
    Submission submission = read_submission(request);
    if (!submission.asset.empty()) {
        if (!service.assets.find(request.principal, submission.asset))
            refuse(422, "asset_not_found", "there is no asset " + submission.asset.substr(0, 80));
        submission.make_model(service.blobs.read(submission.asset));
    }
    return service.tasks.answer(request, Task::inspect, submission.model, submission.request);
}

}  // namespace

http::Route validate_route(const ValidateServices& service) {
    return {"POST", "/v1/validate",
            guarded([service](const http::Request& request) { return validate(service, request); }),
            true};
}

}  // namespace lastflat::server
