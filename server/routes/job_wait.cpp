#include "server/routes/job_wait.h"

#include "server/jobs/job_control.h"
#include "server/routes/answers.h"

namespace lastflat::server {
namespace {

constexpr std::chrono::milliseconds look_at_waiter{250};

}  // namespace

JobRecord JobWait::wait(const http::Request& request, JobRecord job, int seconds) const {
    const WaitingSeat seat(seats_, request);
    if (!seat.is_taken()) return job;
    const auto deadline = JobWatch::Clock::now() + std::chrono::seconds(seconds);
    JobWatch::Subscription subscription(watch_, job.number);
    const bool until_change = request.headers.contains("if-none-match");
    for (;;) {
        job = found_job(jobs_, request.principal, job.id);
        if (is_final(job.state)) return job;
        if (until_change && !has_already(request, view_.etag(job))) return job;
        // The seat of a client that has gone is free for others.
        while (
            !subscription.wait_until(std::min(deadline, JobWatch::Clock::now() + look_at_waiter))) {
            const bool over = JobWatch::Clock::now() >= deadline || watch_.is_closed();
            if (over || request.is_client_gone()) return job;
        }
    }
}

http::Response job_response(const JobView& view, const JobRecord& job, int status) {
    http::Response response = json_response(status, to_json(view.of(job)));
    if (!is_final(job.state)) response.headers.emplace_back("Retry-After", "1");
    return response;
}

}  // namespace lastflat::server
