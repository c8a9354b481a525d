// Where jobs are kept. Every call is safe from any thread, takes effect as a whole, and what it
// changed is on the disk when it returns. All of them throw StoreError if that cannot be.
#pragma once

#include <functional>
#include <map>

#include "server/jobs/job.h"
#include "server/support/files.h"

namespace lastflat::server {

/// A runner's hold on a running job. It is good until the lease ends or somebody else has taken the
/// job; the token tells which.
struct Lease {
    JobNumber job = 0;
    std::int64_t token = 0;
};

struct Claim {
    Lease lease;
    std::string id, owner, tag, model, request;
    std::uint64_t model_bytes = 0;
    std::int64_t created_ms = 0;
    int attempt = 0;
    int retries = 0;  ///< how often it was put off
    std::optional<std::int64_t> cancel_at_ms;
};

enum class Admission {
    queued,
    queue_full,
    owner_queue_full,
    storage_full,  ///< of the owner
    repeated,
    key_reused,
    id_taken
};

struct Admitted {
    Admission admission = Admission::queued;
    std::string id;  ///< of the new job, or of the one that it repeats
};

struct QueueLimits {
    std::size_t queued = 1024;                   ///< jobs waiting
    std::size_t queued_of_owner = 200;           ///< of one key
    std::uint64_t bytes_of_owner = 16ULL << 30;  ///< models, results and assets of one key
};

enum class Release {
    unfinished,  ///< the service ends: the attempt does not count
    lost,        ///< the worker was lost: the attempt counts
    later  ///< there was no room to work: it does not count, but others come first for a while
};

enum class Hold { held, canceling, lost };

struct JobFilter {
    std::optional<JobState> state;
    std::optional<std::string> tag, batch;
    std::optional<std::int64_t> created_after_ms;
    std::optional<std::int64_t> before;  ///< a position given by an earlier list
    std::size_t limit = 50;
};

struct JobList {
    std::vector<JobRecord> jobs;       ///< newest first
    std::optional<std::int64_t> next;  ///< the position where the next list begins
};

struct StateChange {
    std::int64_t revision = 0, at_ms = 0;
    JobState state = JobState::queued;
    int attempt = 0;
};

struct JobCounts {
    std::size_t queued = 0, running = 0;
    std::optional<std::int64_t> oldest_queued_ms;
};

struct Retention {
    std::int64_t result_ms = 24 * 3600'000LL;
    std::int64_t job_ms = 7 * 24 * 3600'000LL;
};

/// What housekeeping did: jobs that changed, blobs that may be needed by nobody now.
struct Swept {
    std::vector<JobNumber> changed;
    std::vector<std::string> blobs;
};

constexpr int most_attempts = 3;
/// How often a job is put off for lack of room, and for how long: from 5 s, doubling, up to 5 min.
constexpr int most_retries = 20;

class JobStore {
public:
    virtual ~JobStore() = default;

    /// Keeps a new job as queued, or says why not. The same id or idempotency key with the same
    /// fingerprint is a repetition and changes nothing. If its question has an answer, it has
    /// succeeded with that at once.
    [[nodiscard]] virtual Admitted add(const NewJob& job, const QueueLimits& limits) = 0;
    /// The same for all jobs of a batch together; the key is the batch's, and the id, too.
    [[nodiscard]] virtual Admitted add(const NewBatch& batch, const QueueLimits& limits) = 0;
    /// The result that would answer the job's question now; empty: there is none.
    [[nodiscard]] virtual std::string answer(const NewJob& job) = 0;
    [[nodiscard]] virtual std::optional<BatchRecord> find_batch(const std::string& owner,
                                                                const std::string& id) = 0;
    [[nodiscard]] virtual std::optional<JobRecord> find(const std::string& owner,
                                                        const std::string& id) = 0;
    /// Whether the job was there and its time is over.
    [[nodiscard]] virtual bool is_expired(const std::string& owner, const std::string& id) = 0;
    /// Of every owner if `owner` is empty: a service without keys has one owner alone.
    [[nodiscard]] virtual JobList list(const std::string& owner, const JobFilter& filter) = 0;
    /// The states a job went through, after the given revision.
    [[nodiscard]] virtual std::vector<StateChange> history(JobNumber job, std::int64_t after) = 0;
    [[nodiscard]] virtual JobCounts counts() = 0;

    /// The next queued job becomes running and is the caller's until the lease ends. Owners take
    /// turns: who has the fewest running is next, and among those who has used workers least. Among
    /// the jobs of one owner the priority decides, then the age.
    [[nodiscard]] virtual std::optional<Claim> claim(std::int64_t lease_ms) = 0;
    /// Extends a lease. `canceling`: held, but to be given up.
    [[nodiscard]] virtual Hold renew(const Lease& lease, std::int64_t lease_ms) = 0;
    /// Ends a running job; one that is being canceled ends as canceled whatever the outcome. The
    /// state then; nothing, and nothing is changed, if the lease was lost.
    [[nodiscard]] virtual std::optional<JobState> finish(const Lease& lease, const JobEnd& end) = 0;
    /// Gives a running job back to the queue. As above.
    [[nodiscard]] virtual std::optional<JobState> release(const Lease& lease, Release why) = 0;

    /// queued becomes canceled, running becomes canceling; other states stay. The state after the
    /// call; nothing if there is no such job.
    [[nodiscard]] virtual std::optional<JobState> cancel(const std::string& owner,
                                                         const std::string& id) = 0;
    /// Forgets a job in whatever state; the blobs that it used. Nothing if there is no such job.
    [[nodiscard]] virtual std::optional<std::vector<std::string>> remove(const std::string& owner,
                                                                         const std::string& id) = 0;

    /// Jobs whose lease is over go back to the queue, or fail with `lost` after the last attempt;
    /// `all_leases`: every lease counts as over (its holder is known to be gone). Deadlines cancel.
    /// Results and jobs past their time are forgotten.
    [[nodiscard]] virtual Swept sweep(bool all_leases, const api::Problem& lost) = 0;
    /// Whether a job or an asset still needs the blob.
    [[nodiscard]] virtual bool needs_blob(const std::string& digest) = 0;
    /// Whether one of the owner's own does.
    [[nodiscard]] virtual bool has_blob(const std::string& owner, const std::string& digest) = 0;
};

}  // namespace lastflat::server
