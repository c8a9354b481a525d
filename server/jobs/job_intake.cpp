#include "server/jobs/job_intake.h"

#include <algorithm>
#include <filesystem>

#include "api/flatten_request.h"
#include "api/object_reader.h"
#include "server/jobs/job_control.h"
#include "server/support/clock.h"
#include "server/support/crypto.h"
#include "server/support/duration.h"
#include "server/support/scope_exit.h"
#include "server/support/version.h"

namespace lastflat::server {
namespace {

/// Nothing without a webhook: fingerprints of earlier versions stay good.
std::string webhook_print(const NewJob& job) {
    if (!job.webhook) return {};
    return "\n" + job.webhook->url + "\n" + api::event_names(job.webhook->events) + "\n" +
           job.webhook->secret;
}

NewJob new_job(const Submission& submission) {
    NewJob job;
    job.id = submission.id.empty() ? new_job_id() : submission.id;
    job.owner = submission.owner;
    job.tag = submission.tag;
    job.batch = submission.batch;
    job.priority = submission.priority.value_or(job.batch.empty() ? api::JobPriority::interactive
                                                                  : api::JobPriority::batch);
    job.request = submission.request;
    job.fresh = submission.fresh;
    job.question = sha256(std::string(build) + "\n" + api::without_tag(submission.request));
    job.idempotency_key = submission.idempotency_key;
    if (const auto after = duration_ms(submission.cancel_after))
        job.cancel_at_ms = now_ms() + *after;
    job.webhook = submission.webhook;
    return job;
}

}  // namespace

void check_room(const BlobStore& blobs, std::size_t min_free_mb) {
    if (blobs.free_bytes() >= min_free_mb << 20) return;
    api::refuse(
        "storage_full",
        "less than " + std::to_string(min_free_mb) +
            " MiB of the service's disk are free (the limit --min-free-mb); its operator has to "
            "make room, or delete jobs and assets that you do not need");
}

void refuse_storage(std::uint64_t bytes_of_owner) {
    api::refuse("quota_exceeded",
                "with this there would be more than " + std::to_string(bytes_of_owner >> 20) +
                    " MiB of models, results and assets of this API key (the limit "
                    "--storage-per-key-mb); delete jobs or assets, or wait until results expire");
}

void require_webhooks(bool webhooks) {
    if (!webhooks)
        api::refuse("webhooks_off",
                    "this service sends no webhooks (--webhooks off); poll instead");
}

bool JobIntake::enter(const std::string& key) {
    const std::scoped_lock lock(mutex_);
    return keys_in_flight_.insert(key).second;
}

void JobIntake::leave(const std::string& key) {
    const std::scoped_lock lock(mutex_);
    keys_in_flight_.erase(key);
}

void JobIntake::refuse_admission(Admission admission) const {
    switch (admission) {
        case Admission::queue_full:
            api::refuse("queue_full",
                        "there is no room in the queue (" + std::to_string(limits_.queue.queued) +
                            " jobs may wait, the limit --queue); try again in a few seconds");
        case Admission::owner_queue_full:
            throw api::Refusal(
                "key_queue_full",
                "with this, the API key would have more than " +
                    std::to_string(limits_.queue.queued_of_owner) +
                    " jobs waiting (the limit --queue-per-key); wait for some to end")
                .with_header("Retry-After", "5");
        case Admission::storage_full: refuse_storage(limits_.queue.bytes_of_owner);
        case Admission::key_reused:
            api::refuse("key_reused",
                        "this Idempotency-Key belongs to another request; take a new key");
        case Admission::id_taken:
            api::refuse("id_taken", "there is another job with this id; choose a new one");
        case Admission::queued:
        case Admission::repeated: break;
    }
    throw std::logic_error("an admission was refused that is none");
}

std::string JobIntake::digest_of_model(const Submission& submission, NewJob& job,
                                       const BlobStore::Holds* own) {
    if (submission.asset.empty()) {
        job.model_bytes = submission.model.size();
        return blobs_.put(submission.model, [&](const std::string& digest) {
            return (own != nullptr && own->has(digest)) || jobs_.has_blob(submission.owner, digest);
        });
    }
    const auto asset = assets_.find(submission.owner, submission.asset);
    if (!asset)
        throw api::Refusal(
            "asset_not_found",
            "there is no asset " + submission.asset.substr(0, 80) + "; send the model first")
            .in_content();
    job.model_bytes = asset->bytes;
    return asset->digest;
}

void JobIntake::complete(const Submission& submission, NewJob& job, const BlobStore::Holds* own) {
    job.model = digest_of_model(submission, job, own);
    job.fingerprint = sha256(job.model + "\n" + submission.cancel_after + "\n" + job.request +
                             webhook_print(job));
    job.question = sha256(job.question + "\n" + job.model);
    const std::string answer = jobs_.answer(job);
    if (!answer.empty() && !std::filesystem::exists(blobs_.path_of(answer))) job.fresh = true;
}

void JobIntake::check_taking() const {
    if (draining_)
        api::refuse("draining", "the service is ending and takes no new jobs; try again later");
    check_room(blobs_, limits_.min_free_mb);
}

template <class Take>
auto JobIntake::alone_with(const std::string& owner, const std::string& key, Take take) {
    const std::string owners_key = owner + " " + key;
    if (!key.empty() && !enter(owners_key))
        api::refuse("key_in_flight",
                    "a request with this Idempotency-Key is being taken right now; ask again");
    const ScopeExit at_end([&] {
        if (!key.empty()) leave(owners_key);
    });
    return take();
}

Submitted JobIntake::submit(const Submission& submission) {
    check_taking();
    if (submission.webhook) require_webhooks(limits_.webhooks);
    return alone_with(submission.owner, submission.idempotency_key, [&]() -> Submitted {
        NewJob job = new_job(submission);
        const Admitted admitted = [&] {
            const auto pin = blobs_.pin();
            complete(submission, job);
            return jobs_.add(job, limits_.queue);
        }();
        if (admitted.admission == Admission::queued) {
            executor_.wake();
            JobRecord taken = found_job(jobs_, job.owner, job.id);
            if (is_final(taken.state)) drop_unneeded(blobs_, jobs_, {job.model});  // no run will
            return {std::move(taken), false};
        }
        drop_unneeded(blobs_, jobs_, {job.model});
        if (admitted.admission != Admission::repeated) refuse_admission(admitted.admission);
        return {found_job(jobs_, job.owner, admitted.id), true};
    });
}

void JobIntake::fill(const BatchSubmission& from, NewBatch& batch, BlobStore::Holds& models) {
    std::string prints;
    for (std::size_t i = 0; i < from.size; ++i) {
        Submission submission = from.submission(i);
        if (submission.webhook) require_webhooks(limits_.webhooks);
        submission.owner = batch.owner;
        submission.batch = batch.id;
        NewJob job = new_job(submission);
        {
            const auto pin = blobs_.pin();
            complete(submission, job, &models);
            models.add(job.model);
        }
        prints += job.fingerprint + "\n";
        batch.jobs.push_back(std::move(job));
    }
    batch.fingerprint = sha256(prints);
}

SubmittedBatch JobIntake::submit(const BatchSubmission& submission) {
    check_taking();
    const std::size_t most = std::min(limits_.queue.queued, limits_.queue.queued_of_owner);
    if (submission.size > most)
        throw api::InvalidRequest("/jobs", "has more jobs than a key may have waiting (" +
                                               std::to_string(most) + ", --queue-per-key)");
    return alone_with(submission.owner, submission.idempotency_key, [&]() -> SubmittedBatch {
        NewBatch batch{new_job_id(), submission.owner, {}, submission.idempotency_key, {}};
        BlobStore::Holds models(blobs_);
        const auto drop_models = [&] { drop_unneeded(blobs_, jobs_, models.clear()); };
        Admitted admitted;
        try {
            fill(submission, batch, models);
            admitted = jobs_.add(batch, limits_.queue);
        } catch (...) {
            drop_models();
            throw;
        }
        if (admitted.admission == Admission::queued) {
            executor_.wake();
            drop_models();  // of jobs that were answered at once
            return {batch.id, false};
        }
        drop_models();
        if (admitted.admission != Admission::repeated) refuse_admission(admitted.admission);
        return {admitted.id, true};
    });
}

}  // namespace lastflat::server
