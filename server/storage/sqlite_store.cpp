#include "server/storage/sqlite_store.h"

#include <cstring>

#include "server/jobs/result_parts.h"
#include "server/storage/sqlite_answers.h"
#include "server/storage/sqlite_rows.h"
#include "server/storage/sqlite_turns.h"
#include "server/support/clock.h"
#include "server/support/crypto.h"

namespace lastflat::server {
namespace {

constexpr std::int64_t expired_memory_ms = 30 * 24 * 3600'000LL;
/// Longer than a message is tried.
constexpr std::int64_t message_memory_ms = 3 * 24 * 3600'000LL;

std::int64_t random_token() {
    const std::string bytes = random_bytes(8);
    std::uint64_t token = 0;
    std::memcpy(&token, bytes.data(), sizeof token);
    return static_cast<std::int64_t>(token >> 1);
}

std::int64_t count(SqliteConnection& connection, const char* sql, const std::string& value = {}) {
    Query query(connection.prepared(sql));
    if (!value.empty()) query.bind(value);
    return query.next() ? query.number(0) : 0;
}

/// What this one repeats, or what stands in its way: it has the same key.
std::optional<Admitted> earlier_with_key(SqliteConnection& connection, const std::string& owner,
                                         const std::string& key, const std::string& fingerprint) {
    if (key.empty()) return std::nullopt;
    Query same_key(
        connection.prepared("SELECT fingerprint, id FROM idempotency WHERE owner = ? AND key = ?"));
    if (!same_key.bind(owner, key).next()) return std::nullopt;
    const bool same = same_key.text(0) == fingerprint;
    return Admitted{same ? Admission::repeated : Admission::key_reused, same_key.text(1)};
}

/// An earlier job that this one repeats, or stands in the way of.
std::optional<Admitted> earlier(SqliteConnection& connection, const NewJob& job) {
    Query same_id(connection.prepared("SELECT fingerprint FROM jobs WHERE owner = ? AND id = ?"));
    if (same_id.bind(job.owner, job.id).next()) {
        const bool same = same_id.text(0) == job.fingerprint;
        return Admitted{same ? Admission::repeated : Admission::id_taken, job.id};
    }
    Query webhook(connection.prepared("SELECT 1 FROM webhooks WHERE owner = ? AND id = ?"));
    if (job.webhook && webhook.bind(job.owner, job.id).next())
        return Admitted{Admission::id_taken, job.id};
    return earlier_with_key(connection, job.owner, job.idempotency_key, job.fingerprint);
}

void note_key(SqliteConnection& connection, const std::string& owner, const std::string& key,
              const std::string& fingerprint, const std::string& id) {
    if (key.empty()) return;
    Query(connection.prepared("INSERT INTO idempotency VALUES (?, ?, ?, ?)"))
        .bind(owner, key, fingerprint, id)
        .run();
}

/// `queued` if so many more jobs with so many bytes of models fit, else why not.
Admission room_for(SqliteConnection& connection, const std::string& owner, std::size_t jobs,
                   std::uint64_t bytes, const QueueLimits& limits) {
    const auto waiting = count(connection, "SELECT count(*) FROM jobs WHERE state = 'queued'");
    if (static_cast<std::size_t>(waiting) + jobs > limits.queued) return Admission::queue_full;
    if (owner.empty()) return Admission::queued;
    const auto own =
        count(connection, "SELECT count(*) FROM jobs WHERE state = 'queued' AND owner = ?", owner);
    if (static_cast<std::size_t>(own) + jobs > limits.queued_of_owner)
        return Admission::owner_queue_full;
    return bytes_kept(connection, owner) + bytes > limits.bytes_of_owner ? Admission::storage_full
                                                                         : Admission::queued;
}

void insert(SqliteConnection& connection, const NewJob& job) {
    enter_job_turns(connection, job.owner);
    Query(connection.prepared(
              "INSERT INTO jobs (id, owner, tag, batch, priority, state, request, model, "
              "model_bytes, fingerprint, created_ms, cancel_at_ms) "
              "VALUES (?, ?, ?, ?, ?, 'queued', ?, ?, ?, ?, ?, ?)"))
        .bind(job.id, job.owner, job.tag, job.batch, static_cast<int>(job.priority), job.request,
              job.model, job.model_bytes, job.fingerprint, now_ms(), job.cancel_at_ms)
        .run();
    JobRow row;
    row.seq = connection.database().getLastInsertRowid();
    row.revision = 1;
    note_change(connection, row);
    note_question(connection, row.seq, job);
    if (job.webhook) {
        add_webhook(connection,
                    {{job.id, job.webhook->url, job.webhook->secret, job.webhook->events, now_ms()},
                     job.owner},
                    job.id);
    }
}

std::vector<std::string> texts_of(Query& query) {
    std::vector<std::string> texts;
    while (query.next()) texts.push_back(query.text(0));
    return texts;
}

std::vector<JobRow> rows_of(SqliteConnection& connection, Query& query) {
    std::vector<JobRow> rows;
    while (query.next()) rows.push_back(row_of(connection, query.number(0)));
    return rows;
}

void end_lost_leases(SqliteConnection& connection, bool all, const api::Problem& lost,
                     Swept& swept) {
    Query over(
        connection.prepared("SELECT seq FROM jobs WHERE state IN ('running', 'canceling') "
                            "AND (lease_until_ms <= ?1 OR ?2)"));
    for (JobRow& row : rows_of(connection, over.bind(now_ms(), all ? 1 : 0))) {
        if (row.state == JobState::canceling) {
            change_state(connection, row, JobState::canceled);
        } else if (row.attempt >= most_attempts) {
            change_state(connection, row, JobState::failed);
            Query(connection.prepared("UPDATE jobs SET error = ? WHERE seq = ?"))
                .bind(to_json(lost), row.seq)
                .run();
        } else {
            change_state(connection, row, JobState::queued);
        }
        swept.changed.push_back(row.seq);
        swept.blobs.push_back(row.model);
    }
}

void end_overdue(SqliteConnection& connection, Swept& swept) {
    Query overdue(connection.prepared(
        "SELECT seq FROM jobs INDEXED BY jobs_by_deadline WHERE finished_ms IS NULL AND "
        "cancel_at_ms <= ? AND state IN ('queued', 'running')"));
    for (JobRow& row : rows_of(connection, overdue.bind(now_ms()))) {
        const bool waits = row.state == JobState::queued;
        change_state(connection, row, waits ? JobState::canceled : JobState::canceling, "deadline");
        swept.changed.push_back(row.seq);
        swept.blobs.push_back(row.model);
    }
}

void forget_expired(SqliteConnection& connection, const Retention& retention, Swept& swept) {
    Query results(
        connection.prepared("SELECT result FROM jobs INDEXED BY jobs_with_result "
                            "WHERE finished_ms <= ? AND result <> '' LIMIT 1000"));
    results.bind(now_ms() - retention.result_ms);
    for (const std::string& blob : texts_of(results)) {
        Query(
            connection.prepared("UPDATE jobs SET result = '', parts = '', revision = revision + 1 "
                                "WHERE result = ? AND result <> '' AND finished_ms <= ?"))
            .bind(blob, now_ms() - retention.result_ms)
            .run();
        swept.blobs.push_back(blob);
    }
    Query jobs(connection.prepared("SELECT seq FROM jobs WHERE finished_ms <= ? LIMIT 1000"));
    for (const JobRow& row : rows_of(connection, jobs.bind(now_ms() - retention.job_ms))) {
        Query(connection.prepared("INSERT OR REPLACE INTO expired VALUES (?, ?, ?)"))
            .bind(row.owner, row.id, now_ms())
            .run();
        if (!row.result.empty()) swept.blobs.push_back(row.result);
        erase_row(connection, row);
    }
    Query(connection.prepared("DELETE FROM deliveries WHERE seq IN (SELECT seq FROM deliveries "
                              "ORDER BY seq LIMIT 200) AND created_ms <= ?"))
        .bind(now_ms() - message_memory_ms)
        .run();
    Query(connection.prepared("DELETE FROM silent_receivers AS r WHERE NOT EXISTS (SELECT 1 FROM "
                              "deliveries INDEXED BY deliveries_by_receiver WHERE owner = r.owner "
                              "AND receiver = r.receiver AND next_ms IS NOT NULL)"))
        .run();
    Query(connection.prepared("DELETE FROM expired WHERE at_ms <= ?"))
        .bind(now_ms() - expired_memory_ms)
        .run();
}

}  // namespace

Admitted SqliteStore::add(const NewJob& job, const QueueLimits& limits) {
    return database_.write([&](SqliteConnection& connection) -> Admitted {
        if (const auto found = earlier(connection, job)) return *found;
        const auto answer = answer_to(connection, job);
        const Admission room = answer ? room_for(connection, job.owner, 0, 0, limits)
                                      : room_for(connection, job.owner, 1, job.model_bytes, limits);
        if (room != Admission::queued) return {room, {}};
        insert(connection, job);
        if (answer) give_answer(connection, job, *answer);
        note_key(connection, job.owner, job.idempotency_key, job.fingerprint, job.id);
        return {Admission::queued, job.id};
    });
}

Admitted SqliteStore::add(const NewBatch& batch, const QueueLimits& limits) {
    return database_.write([&](SqliteConnection& connection) -> Admitted {
        if (const auto found =
                earlier_with_key(connection, batch.owner, batch.idempotency_key, batch.fingerprint))
            return *found;
        std::vector<std::pair<const NewJob*, JobNumber>> answered;
        std::uint64_t bytes = 0;
        for (const NewJob& job : batch.jobs) {
            const auto answer = answer_to(connection, job);
            if (answer) answered.emplace_back(&job, *answer);
            bytes += answer ? 0 : job.model_bytes;
        }
        const Admission room =
            room_for(connection, batch.owner, batch.jobs.size() - answered.size(), bytes, limits);
        if (room != Admission::queued) return {room, {}};
        Query(connection.prepared("INSERT INTO batches VALUES (?, ?, ?, NULL, ?)"))
            .bind(batch.owner, batch.id, now_ms(), std::uint64_t{batch.jobs.size()})
            .run();
        for (const NewJob& job : batch.jobs) insert(connection, job);
        for (const auto& [job, answer] : answered) give_answer(connection, *job, answer);
        note_key(connection, batch.owner, batch.idempotency_key, batch.fingerprint, batch.id);
        return {Admission::queued, batch.id};
    });
}

std::optional<Claim> SqliteStore::claim(std::int64_t lease_ms) {
    return database_.write([&](SqliteConnection& connection) -> std::optional<Claim> {
        const auto owner = take_job_turn(connection);
        if (!owner) return std::nullopt;
        Query next(connection.prepared(
            "SELECT seq FROM jobs WHERE state = 'queued' AND owner = ? AND not_before_ms <= ? "
            "ORDER BY priority DESC, seq LIMIT 1"));
        if (!next.bind(*owner, now_ms()).next()) return std::nullopt;
        JobRow row = row_of(connection, next.number(0));
        ++row.attempt;
        change_state(connection, row, JobState::running);
        const std::int64_t token = random_token();
        Query(connection.prepared(
                  "UPDATE jobs SET lease_token = ?, lease_until_ms = ? WHERE seq = ?"))
            .bind(token, now_ms() + lease_ms, row.seq)
            .run();
        Query job(connection.prepared(
            "SELECT tag, request, model_bytes, created_ms, retries, cancel_at_ms FROM jobs "
            "WHERE seq = ?"));
        if (!job.bind(row.seq).next()) return std::nullopt;
        return Claim{{row.seq, token},
                     row.id,
                     row.owner,
                     job.text(0),
                     row.model,
                     job.text(1),
                     static_cast<std::uint64_t>(job.number(2)),
                     job.number(3),
                     row.attempt,
                     static_cast<int>(job.number(4)),
                     job.maybe_number(5)};
    });
}

Hold SqliteStore::renew(const Lease& lease, std::int64_t lease_ms) {
    return database_.write([&](SqliteConnection& connection) {
        const auto row = leased_row(connection, lease);
        if (!row) return Hold::lost;
        Query(connection.prepared("UPDATE jobs SET lease_until_ms = ? WHERE seq = ?"))
            .bind(now_ms() + lease_ms, row->seq)
            .run();
        return row->state == JobState::canceling ? Hold::canceling : Hold::held;
    });
}

std::optional<JobState> SqliteStore::finish(const Lease& lease, const JobEnd& end) {
    return database_.write([&](SqliteConnection& connection) -> std::optional<JobState> {
        auto row = leased_row(connection, lease);
        if (!row) return std::nullopt;
        if (row->state == JobState::canceling) {
            change_state(connection, *row, JobState::canceled);
            return row->state;
        }
        if (const auto* failed = std::get_if<Failed>(&end)) {
            change_state(connection, *row, JobState::failed);
            Query(connection.prepared("UPDATE jobs SET error = ? WHERE seq = ?"))
                .bind(to_json(failed->problem), row->seq)
                .run();
        } else {
            const auto& [result, parts] = std::get<Succeeded>(end);
            change_state(connection, *row, JobState::succeeded);
            Query(connection.prepared(
                      "UPDATE jobs SET result = ?, parts = ?, result_bytes = ? WHERE seq = ?"))
                .bind(result, to_json(parts), size_of(parts), row->seq)
                .run();
        }
        return row->state;
    });
}

std::optional<JobState> SqliteStore::release(const Lease& lease, Release why) {
    return database_.write([&](SqliteConnection& connection) -> std::optional<JobState> {
        auto row = leased_row(connection, lease);
        if (!row) return std::nullopt;
        if (row->state == JobState::canceling) {
            change_state(connection, *row, JobState::canceled);
            return row->state;
        }
        if (why != Release::lost) --row->attempt;
        change_state(connection, *row, JobState::queued);
        if (why == Release::later) {
            Query(connection.prepared("UPDATE jobs SET retries = retries + 1, not_before_ms = ?1 + "
                                      "min(5000 << min(retries, 10), 300000) WHERE seq = ?2"))
                .bind(now_ms(), row->seq)
                .run();
        }
        return row->state;
    });
}

std::optional<JobState> SqliteStore::cancel(const std::string& owner, const std::string& id) {
    return database_.write([&](SqliteConnection& connection) -> std::optional<JobState> {
        auto row = find_row(connection, owner, id);
        if (!row) return std::nullopt;
        if (row->state == JobState::queued)
            change_state(connection, *row, JobState::canceled, "client");
        else if (row->state == JobState::running)
            change_state(connection, *row, JobState::canceling, "client");
        return row->state;
    });
}

std::optional<std::vector<std::string>> SqliteStore::remove(const std::string& owner,
                                                            const std::string& id) {
    return database_.write(
        [&](SqliteConnection& connection) -> std::optional<std::vector<std::string>> {
            const auto row = find_row(connection, owner, id);
            if (!row) return std::nullopt;
            charge_worker(connection, *row);
            erase_row(connection, *row);
            std::vector<std::string> blobs{row->model};
            if (!row->result.empty()) blobs.push_back(row->result);
            return blobs;
        });
}

Swept SqliteStore::sweep(bool all_leases, const api::Problem& lost) {
    return database_.write([&](SqliteConnection& connection) {
        Swept swept;
        end_lost_leases(connection, all_leases, lost, swept);
        end_overdue(connection, swept);
        forget_expired(connection, retention_, swept);
        return swept;
    });
}

}  // namespace lastflat::server
