#include "server/routes/task_answer.h"

#include <nlohmann/json.hpp>

#include "server/routes/answers.h"

namespace lastflat::server {

using http::Response;
using Json = nlohmann::ordered_json;

Response TaskAnswers::answer(const http::Request& request, Task task, std::string_view model,
                             std::string_view text) const {
    const WaitingSeat seat(seats_, request);
    if (!seat.is_taken())
        refuse(503, "validations_full",
               "too many models and patterns are being looked at; try again later");
    const ProcessEnd end = run_(task, model, text);
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
