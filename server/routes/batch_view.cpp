#include "server/routes/batch_view.h"

#include <algorithm>

#include "api/batch.h"
#include "api/refusal.h"

namespace lastflat::server {

BatchRecord BatchView::found(const http::Request& request, const std::string& id) const {
    auto batch = jobs_.find_batch(request.principal, id);
    if (!batch)
        api::refuse("batch_not_found", "there is no batch " + id + ", or none of its jobs is left");
    return std::move(*batch);
}

std::vector<JobRecord> BatchView::jobs_of(const BatchRecord& batch) const {
    JobFilter filter;
    filter.batch = batch.id;
    filter.limit = api::most_batch_jobs;
    JobList list = jobs_.list(batch.owner, filter);
    std::reverse(list.jobs.begin(), list.jobs.end());
    return std::move(list.jobs);
}

std::string BatchView::json(const BatchRecord& batch) const {
    api::Batch shown{batch.id, batch.created_ms, batch.finished_ms, batch.size, batch.states, {}};
    for (const JobRecord& job : jobs_of(batch)) shown.items.push_back(view_.of(job));
    return to_json(shown);
}

BatchRecord BatchView::wait(const http::Request& request, BatchRecord batch, int seconds) const {
    const WaitingSeat seat(seats_, request);
    const auto deadline = JobWatch::Clock::now() + std::chrono::seconds(seconds);
    while (seat.is_taken() && !batch.finished_ms && JobWatch::Clock::now() < deadline &&
           !watch_.is_closed() && !request.is_client_gone()) {
        // Whatever happens to one of its jobs ends the wait for it; what does not is looked for.
        JobWatch::Subscription subscription(watch_, batch.unfinished.value_or(0));
        const BatchRecord now = found(request, batch.id);
        if (now.revision == batch.revision)
            (void)subscription.wait_until(JobWatch::Clock::now() + look_at_batch);
        batch = found(request, batch.id);
    }
    return batch;
}

}  // namespace lastflat::server
