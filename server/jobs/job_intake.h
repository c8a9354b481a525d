// From what a client sends to a job on the disk.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "server/jobs/asset_store.h"
#include "server/jobs/blob_store.h"
#include "server/jobs/job_executor.h"
#include "server/jobs/job_store.h"

namespace lastflat::server {

/// What is asked for, and by whom.
struct Submission {
    std::string_view model;  ///< the bytes, of the request's body or of `made`; empty with `asset`
    std::shared_ptr<const std::string> made;  ///< a model that did not come as it is
    std::string asset;                        ///< digest of an asset
    std::string request;  ///< the constraint JSON, valid; may be empty: every default
    std::string tag;
    std::optional<api::WebhookRequest> webhook;

    std::string owner;                         ///< id of the API key; empty: the service is open
    std::string id;                            ///< chosen by the client, else empty
    std::string batch;                         ///< id of the batch it came in; empty: alone
    std::string idempotency_key;               ///< empty: none
    std::string cancel_after;                  ///< a duration as it was written; empty: never
    bool fresh = false;                        ///< a result that is there already will not do
    std::optional<api::JobPriority> priority;  ///< else that of a job alone, or in a batch

    void make_model(std::string bytes) {
        made = std::make_shared<const std::string>(std::move(bytes));
        model = *made;
    }
};

struct Submitted {
    JobRecord job;
    bool repeated = false;  ///< it was there already, the same
};

/// Submissions that are taken together or not at all.
struct BatchSubmission {
    std::string owner, idempotency_key;
    std::size_t size = 0;
    /// Reads one of them. Throws: api::Refusal naming its field.
    std::function<Submission(std::size_t index)> submission;
};

struct SubmittedBatch {
    std::string id;
    bool repeated = false;
};

struct IntakeLimits {
    QueueLimits queue;
    std::size_t min_free_mb = 512;  ///< of the disk
    bool webhooks = false;          ///< whether a job may have one
};

/// Throws: api::Refusal (507) if the disk has less room than the operator wants to keep;
/// StoreError.
void check_room(const BlobStore& blobs, std::size_t min_free_mb);

/// Throws: api::Refusal (507): the owner keeps as much as it may.
[[noreturn]] void refuse_storage(std::uint64_t bytes_of_owner);

/// Throws: api::Refusal (403) unless the service sends webhooks.
void require_webhooks(bool webhooks);

/// Takes jobs. Safe from any thread.
class JobIntake {
public:
    /// All must outlive it. `draining`: take no more.
    JobIntake(JobStore& jobs, AssetStore& assets, const BlobStore& blobs, JobExecutor& executor,
              const IntakeLimits& limits, const std::atomic<bool>& draining)
        : jobs_(jobs),
          assets_(assets),
          blobs_(blobs),
          executor_(executor),
          limits_(limits),
          draining_(draining) {}

    /// Keeps a job; on the disk when this returns.
    /// Throws: api::Refusal (403, 409, 422, 429, 503, 507), StoreError.
    [[nodiscard]] Submitted submit(const Submission& submission);
    /// Keeps all jobs of a batch, or none. Throws as above.
    [[nodiscard]] SubmittedBatch submit(const BatchSubmission& batch);

private:
    /// Where the model is kept; its size goes into the job.
    [[nodiscard]] std::string digest_of_model(const Submission& submission, NewJob& job,
                                              const BlobStore::Holds* own);
    /// Keeps the model and says what the job is.
    /// `own`: what the same client has brought just now.
    void complete(const Submission& submission, NewJob& job, const BlobStore::Holds* own = nullptr);
    void fill(const BatchSubmission& from, NewBatch& batch, BlobStore::Holds& models);
    void check_taking() const;
    /// Calls `take` while no other request with this key is being taken.
    template <class Take>
    auto alone_with(const std::string& owner, const std::string& key, Take take);
    [[noreturn]] void refuse_admission(Admission admission) const;
    /// False: a request with this key is being taken right now.
    [[nodiscard]] bool enter(const std::string& key);
    void leave(const std::string& key);

    JobStore& jobs_;
    AssetStore& assets_;
    const BlobStore& blobs_;
    JobExecutor& executor_;
    const IntakeLimits limits_;
    const std::atomic<bool>& draining_;
    std::mutex mutex_;
    std::set<std::string> keys_in_flight_;
};

}  // namespace lastflat::server
