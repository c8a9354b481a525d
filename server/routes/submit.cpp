#include "server/routes/submit.h"

#include "server/routes/job_view.h"
#include "server/routes/webhook_routes.h"
#include "server/support/clock.h"
#include "server/support/crypto.h"
#include "server/support/duration.h"

namespace lastflat::server {
namespace {

constexpr std::size_t longest_key = 255;

/// The key of a request; quoted as the draft has it, or bare.
std::string idempotency_key(const http::Request& request) {
    std::string_view key = request.header("idempotency-key");
    if (key.size() >= 2 && key.front() == '"' && key.back() == '"')
        key = key.substr(1, key.size() - 2);
    if (key.empty() && request.headers.contains("idempotency-key"))
        refuse(400, "header_invalid", "Idempotency-Key is empty");
    if (key.size() > longest_key)
        refuse(400, "header_invalid",
               "Idempotency-Key has more than " + std::to_string(longest_key) + " bytes");
    return std::string(key);
}

std::optional<std::int64_t> cancel_time(const http::Request& request) {
    const std::string_view text = request.header("cancel-after");
    if (text.empty()) return std::nullopt;
    const auto after = duration_ms(text);
    if (!after)
        refuse(400, "header_invalid", "Cancel-After is not a duration such as 90s, 2m or 1h");
    return now_ms() + *after;
}

/// While one request with a key is being taken, a second one must not overtake it.
class InFlight {
public:
    InFlight(KeysInFlight& keys, std::string key) : keys_(keys), key_(std::move(key)) {
        if (!key_.empty() && !keys_.enter(key_))
            refuse(409, "key_in_flight",
                   "a request with this Idempotency-Key is being taken right now; ask again");
    }
    ~InFlight() {
        if (!key_.empty()) keys_.leave(key_);
    }
    InFlight(const InFlight&) = delete;
    InFlight& operator=(const InFlight&) = delete;

private:
    KeysInFlight& keys_;
    const std::string key_;
};

[[noreturn]] void refuse_admission(Admission admission, const Settings& settings) {
    switch (admission) {
        case Admission::queue_full:
            refuse(503, "queue_full",
                   "the queue is full (" + std::to_string(settings.queue) +
                       " jobs wait, the limit --queue); try again in a few seconds");
        case Admission::owner_queue_full:
            refuse(429, "key_queue_full",
                   "this API key has " + std::to_string(settings.queue_per_key) +
                       " jobs waiting (the limit --queue-per-key); wait for some to end");
        case Admission::key_reused:
            refuse(422, "key_reused",
                   "this Idempotency-Key belongs to another request; take a new key");
        case Admission::id_taken:
            refuse(409, "id_taken", "there is another job with this id; choose a new one");
        case Admission::queued:
        case Admission::repeated: break;
    }
    throw std::logic_error("an admission was refused that is none");
}

std::string digest_of_model(Service& service, const std::string& owner,
                            const Submission& submission, NewJob& job) {
    if (submission.asset.empty()) {
        job.model_bytes = submission.model.size();
        return service.blobs.put(submission.model);
    }
    const auto asset = service.assets.find(owner, submission.asset);
    if (!asset)
        refuse(422, "asset_not_found",
               "there is no asset " + submission.asset.substr(0, 80) + "; send the model first");
    job.model_bytes = asset->bytes;
    return asset->digest;
}

/// Nothing without a webhook: fingerprints of earlier versions stay good.
std::string webhook_print(const NewJob& job) {
    if (!job.webhook) return {};
    return "\n" + job.webhook->url + "\n" + job.webhook->events + "\n" + job.webhook->secret;
}

}  // namespace

void check_room(const Service& service) {
    if (service.blobs.free_bytes() >= service.settings.min_free_mb << 20) return;
    refuse(507, "storage_full",
           "less than " + std::to_string(service.settings.min_free_mb) +
               " MiB of the service's disk are free (the limit --min-free-mb); its operator has to "
               "make room, or delete jobs and assets that you do not need");
}

Submitted submit(Service& service, const http::Request& request, const Submission& submission,
                 const std::string& id, const std::string& batch) {
    if (service.draining)
        refuse(503, "draining", "the service is ending and takes no new jobs; try again later");
    if (submission.webhook) require_webhooks(service.settings);
    check_room(service);
    NewJob job;
    job.id = id.empty() ? new_job_id() : id;
    job.owner = request.principal;
    job.tag = submission.tag;
    job.batch = batch;
    job.request = submission.request;
    job.idempotency_key = idempotency_key(request);
    job.cancel_at_ms = cancel_time(request);
    job.webhook = submission.webhook;
    const InFlight in_flight(service.keys_in_flight, job.idempotency_key.empty()
                                                         ? ""
                                                         : job.owner + " " + job.idempotency_key);
    Admitted admitted;
    {
        const auto pin = service.blobs.pin();
        job.model = digest_of_model(service, job.owner, submission, job);
        job.fingerprint = sha256(job.model + "\n" + std::string(request.header("cancel-after")) +
                                 "\n" + job.request + webhook_print(job));
        admitted = service.jobs.add(job, {service.settings.queue, service.settings.queue_per_key});
    }
    if (admitted.admission == Admission::queued) {
        service.workers.wake();
        return {found_job(service, job.owner, job.id), false};
    }
    drop_unneeded(service.blobs, service.jobs, {job.model});
    if (admitted.admission != Admission::repeated)
        refuse_admission(admitted.admission, service.settings);
    return {found_job(service, job.owner, admitted.id), true};
}

}  // namespace lastflat::server
