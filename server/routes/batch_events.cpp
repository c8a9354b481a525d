#include "server/routes/batch_events.h"

#include <map>
#include <thread>

#include "api/refusal.h"
#include "server/routes/server_sent_event.h"

namespace lastflat::server {
namespace {

using Clock = JobWatch::Clock;

/// One client's view of one batch. Lives on its connection's thread.
class BatchStream {
public:
    BatchStream(const BatchEventServices& service, const http::Request& request)
        : service_(service),
          request_(request),
          id_(request.captures.at(0)),
          seat_(service.seats, request) {}

    [[nodiscard]] bool has_seat() const { return seat_.is_taken(); }

    /// Sends what there is, or waits a while. False: it is over.
    bool step(const http::Write& write) {
        if (!first_) std::this_thread::sleep_for(look_at_batch);
        if (service_.watch.is_closed()) {
            write(event("shutdown", "{}"));
            return false;
        }
        std::string news = first_ ? "retry: 2000\n\n" : "";
        first_ = false;
        const bool goes_on = add_news(news);
        if (news.empty() && Clock::now() - last_sent_ >= heartbeat) news = ": still here\n\n";
        if (news.empty()) return goes_on;
        last_sent_ = Clock::now();
        return write(news) && goes_on;
    }

private:
    bool add_news(std::string& news) {
        try {
            const BatchRecord batch = service_.view.found(request_, id_);
            if (batch.revision == revision_ && !batch.finished_ms) return true;
            revision_ = batch.revision;
            for (const JobRecord& job : service_.view.jobs_of(batch)) {
                auto& seen = seen_[job.number];
                if (seen == job.revision) continue;
                seen = job.revision;
                news += event("job", to_json(service_.view.of(job)));
            }
            if (!batch.finished_ms) return true;
            news += event("done", service_.view.json(batch));
        } catch (const api::Refusal& refusal) {
            if (refusal.problem().status != 404) throw;
            news += event("deleted", "{}");
        }
        return false;
    }

    const BatchEventServices service_;
    const http::Request request_;
    const std::string id_;
    const WaitingSeat seat_;
    std::map<JobNumber, std::int64_t> seen_;  ///< revisions that the client has
    std::int64_t revision_ = 0;               ///< of the batch, then
    bool first_ = true;
    Clock::time_point last_sent_ = Clock::now();
};

http::Response events(const BatchEventServices& service, const http::Request& request) {
    (void)service.view.found(request, request.captures.at(0));
    return event_response(std::make_shared<BatchStream>(service, request), "batch");
}

}  // namespace

http::Route batch_event_route(const BatchEventServices& service) {
    return {"GET", "/v1/batches/{id}/events",
            [service](const http::Request& request) { return events(service, request); }};
}

}  // namespace lastflat::server
