#include "server/routes/task_answer.h"

#include "api/refusal.h"

namespace lastflat::server {

std::string TaskAnswers::report(const http::Request& request, Task task, std::string_view model,
                                std::string_view text) const {
    const WaitingSeat seat(seats_, request);
    if (!seat.is_taken())
        api::refuse("validations_full",
                    "too many models and patterns are being looked at; try again later");
    ProcessEnd end = run_({request.principal, task, model, text, request.is_client_gone});
    if (auto* report = std::get_if<Report>(&end)) return std::move(report->content);
    if (const auto* failed = std::get_if<Failed>(&end)) throw api::Refusal(failed->problem);
    const auto* unfinished = std::get_if<Unfinished>(&end);
    const auto kind = unfinished != nullptr ? unfinished->kind : Unfinished::Kind::crashed;
    if (kind == Unfinished::Kind::timed_out)
        api::refuse("job_too_slow", "the model took too long to look at; send a coarser one");
    if (kind == Unfinished::Kind::stopped)
        api::refuse("draining", "the service is ending; try again later");
    api::refuse("worker_crashed", "the program broke on this model; the service goes on");
}

}  // namespace lastflat::server
