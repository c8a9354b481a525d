// What the statements about jobs have in common.
#pragma once

#include "server/jobs/job_store.h"
#include "server/jobs/webhook_store.h"
#include "server/storage/sqlite.h"

namespace lastflat::server {

/// What a change of state needs to know of a job.
struct JobRow {
    std::int64_t seq = 0, revision = 0;
    JobState state = JobState::queued;
    int attempt = 0;
    std::string id, owner, batch, model, result;
};

/// Throws: StoreError if it is none.
[[nodiscard]] JobState state_of(const std::string& word);

/// The columns of `record_of`.
inline constexpr char record_columns[] =
    "seq, id, owner, tag, batch, state, reason, fingerprint, model_bytes, created_ms, started_ms, "
    "finished_ms, cancel_at_ms, attempt, revision, error, result, parts, model, priority";
[[nodiscard]] JobRecord record_of(const Query& query, const Retention& retention);

[[nodiscard]] std::optional<JobRow> find_row(SqliteConnection& connection, const std::string& owner,
                                             const std::string& id);
/// Throws: StoreError if there is no such job.
[[nodiscard]] JobRow row_of(SqliteConnection& connection, JobNumber job);
/// The job while the lease is good; nothing once it was lost.
[[nodiscard]] std::optional<JobRow> leased_row(SqliteConnection& connection, const Lease& lease);

/// Every change of a job's state goes through here.
/// Throws: std::logic_error if the job may not become that.
void change_state(SqliteConnection& connection, JobRow& row, JobState to,
                  const std::string& reason = {});

/// The worker that the job has, if it has one, is used up to now.
void charge_worker(SqliteConnection& connection, const JobRow& row);

/// A new job's first state.
void note_change(SqliteConnection& connection, const JobRow& row);

/// Messages to one receiver of an owner that may wait, and of all; what comes beyond is dropped.
inline constexpr int most_pending_messages = 1000, most_pending_of_owner = 10'000;

/// A message to a webhook, to be sent at once. False: there is no such webhook any more, or too
/// many of its messages wait.
[[nodiscard]] bool add_delivery(SqliteConnection& connection, const std::string& owner,
                                const std::string& webhook, const api::WebhookMessage& message,
                                int most_pending);

/// `job`: the only one that it tells of; empty: every job of its owner.
void add_webhook(SqliteConnection& connection, const Webhook& webhook, const std::string& job);
/// Forgets its messages too.
void erase_webhook(SqliteConnection& connection, const std::string& owner, const std::string& id);

/// How many of the batch's jobs that are left are in each state.
[[nodiscard]] std::map<JobState, std::size_t> batch_states(SqliteConnection& connection,
                                                           const std::string& owner,
                                                           const std::string& id);

/// Bytes of the owner's models, results and assets together.
[[nodiscard]] std::uint64_t bytes_kept(SqliteConnection& connection, const std::string& owner);

/// Forgets the job's row and all that hangs on it.
void erase_row(SqliteConnection& connection, const JobRow& row);

}  // namespace lastflat::server
