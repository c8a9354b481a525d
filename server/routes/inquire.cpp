#include "server/routes/inquire.h"

#include <nlohmann/json.hpp>

#include "server/routes/answers.h"
#include "server/routes/waiting_place.h"

namespace lastflat::server {

using http::Response;
using Json = nlohmann::ordered_json;

Response inquire(Service& service, const http::Request& request, Task task,
                 const std::string& model, const std::string& text) {
    const WaitingPlace place(service, request);
    if (!place.is_taken())
        refuse(503, "validations_full",
               "too many models and patterns are being looked at; try again later");
    const ProcessEnd end = service.inquire(task, model, text);
    if (end.kind == ProcessEnd::Kind::timed_out)
        refuse(422, "job_too_slow", "the model took too long to look at; send a coarser one");
    if (end.kind == ProcessEnd::Kind::stopped)
        refuse(503, "draining", "the service is ending; try again later");
    if (end.kind != ProcessEnd::Kind::finished)
        refuse(500, "worker_crashed", "the program broke on this model; the service goes on");
    if (end.report.empty()) {
        const Json problem = Json::parse(end.outcome.error);
        Response response = json_response(problem.at("status"), end.outcome.error);
        response.media_type = "application/problem+json";
        return response;
    }
    return json_response(200, end.report);
}

}  // namespace lastflat::server
