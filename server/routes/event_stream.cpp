#include "server/routes/event_stream.h"

#include <charconv>

#include "api/job_event.h"
#include "api/refusal.h"
#include "server/jobs/job_control.h"
#include "server/jobs/result_parts.h"
#include "server/routes/answers.h"
#include "server/routes/server_sent_event.h"

namespace lastflat::server {
namespace {

using Clock = JobWatch::Clock;

/// A client that has gone is noticed at the latest then.
constexpr std::chrono::seconds look_at_client{1};

/// One client's view of one job. Lives on its connection's thread.
class EventStream {
public:
    EventStream(const EventServices& service, const http::Request& request, const JobRecord& job,
                std::int64_t seen)
        : service_(service),
          owner_(request.principal),
          id_(job.id),
          number_(job.number),
          seat_(service.seats, request),
          subscription_(service.watch, number_),
          seen_(seen) {}

    [[nodiscard]] bool has_seat() const { return seat_.is_taken(); }

    /// Sends what there is, or waits a while. False: it is over.
    bool step(const http::Write& write) {
        if (first_) {
            first_ = false;
            return write("retry: 2000\n\n") && send_news(write);
        }
        if (subscription_.wait_until(Clock::now() + look_at_client)) return send_news(write);
        if (service_.watch.is_closed()) {
            write("event: shutdown\ndata: {}\n\n");
            return false;
        }
        if (Clock::now() - last_sent_ < heartbeat) return true;
        last_sent_ = Clock::now();
        return write(": still here\n\n");
    }

private:
    /// What the result says of the model and of itself.
    [[nodiscard]] std::string remarks(const JobRecord& job) const {
        if (job.state != JobState::succeeded || job.result.empty()) return {};
        std::vector<std::string> logs;
        try {
            logs = api::log_events(result_bytes(service_.blobs, job, result_part(job, "metrics")));
        } catch (const api::Refusal& refusal) {  // as whoever asks for the result will be told
            logs = {api::log_event(refusal.problem())};
        }
        std::string events;
        for (const std::string& log : logs)
            events += event("log", log, std::to_string(job.revision));
        return events;
    }

    bool send_news(const http::Write& write) {
        const auto job = service_.jobs.find(owner_, id_);
        if (!job || job->number != number_) {
            write("event: deleted\ndata: {}\n\n");
            return false;
        }
        std::string news;
        for (const StateChange& change : service_.jobs.history(number_, seen_)) {
            if (change.revision > job->revision) break;
            seen_ = change.revision;
            progress_seen_ = 0;
            news +=
                event("state", to_json(api::StateEvent{change.state, change.at_ms, change.attempt}),
                      std::to_string(seen_));
        }
        if (is_final(job->state)) {
            news += remarks(*job);
            news += event("done", to_json(service_.view.of(*job)), std::to_string(job->revision));
            write(news);
            return false;
        }
        if (const auto progress = service_.watch.progress(number_);
            progress && job->state == JobState::running && progress->number != progress_seen_) {
            progress_seen_ = progress->number;
            const api::ProgressEvent reached{progress->stage,
                                             static_cast<int>(100.0 * progress->fraction)};
            news += event("progress", to_json(reached), std::to_string(seen_));
        }
        if (news.empty()) return true;
        last_sent_ = Clock::now();
        return write(news);
    }

    const EventServices service_;
    const std::string owner_, id_;
    const JobNumber number_;
    const WaitingSeat seat_;
    JobWatch::Subscription subscription_;
    std::int64_t seen_;  ///< the last revision that the client has
    std::int64_t progress_seen_ = 0;
    bool first_ = true;
    Clock::time_point last_sent_ = Clock::now();
};

std::int64_t last_event(const http::Request& request) {
    const std::string_view text = request.header("last-event-id");
    std::int64_t revision = 0;
    std::from_chars(text.data(), text.data() + text.size(), revision);
    return revision;
}

http::Response events(const EventServices& service, const http::Request& request) {
    const std::string_view accept = request.header("accept");
    const bool fits = accept.empty() || accept.find("text/event-stream") != std::string::npos ||
                      accept.find("text/*") != std::string::npos ||
                      accept.find("*/*") != std::string::npos;
    if (!fits)
        api::refuse("not_acceptable", "this is text/event-stream; poll the job for JSON instead");
    const JobRecord job = found_job(service.jobs, request.principal, request.captures.at(0));
    const std::int64_t seen = last_event(request);
    // What an EventSource asks after the end; this answer keeps it from asking again and again.
    if (is_final(job.state) && seen >= job.revision) return empty_response(204);
    return event_response(std::make_shared<EventStream>(service, request, job, seen), "job");
}

}  // namespace

http::Route event_route(const EventServices& service) {
    return {"GET",
            "/v1/jobs/{id}/events",
            [service](const http::Request& request) { return events(service, request); },
            false,
            false,
            {"token"}};
}

}  // namespace lastflat::server
