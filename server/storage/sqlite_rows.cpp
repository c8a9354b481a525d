#include "server/storage/sqlite_rows.h"

#include "server/jobs/result_parts.h"
#include "server/storage/sqlite_answers.h"
#include "server/storage/sqlite_turns.h"
#include "server/support/clock.h"

namespace lastflat::server {
namespace {

JobRow row_of(const Query& query) {
    return {query.number(0),
            query.number(1),
            state_of(query.text(2)),
            static_cast<int>(query.number(3)),
            query.text(4),
            query.text(5),
            query.text(6),
            query.text(7),
            query.text(8)};
}

/// The columns of `row_of`.
const std::string select_row =
    "SELECT seq, revision, state, attempt, id, owner, batch, model, result FROM jobs ";

}  // namespace

JobState state_of(const std::string& word) {
    const auto state = api::value_of(api::job_states, word);
    if (!state) throw StoreError("the database has a job in the unknown state '" + word + "'");
    return *state;
}

JobRecord record_of(const Query& query, const Retention& retention) {
    JobRecord job;
    job.number = query.number(0);
    job.id = query.text(1);
    job.owner = query.text(2);
    job.tag = query.text(3);
    job.batch = query.text(4);
    job.state = state_of(query.text(5));
    job.reason = query.text(6);
    job.fingerprint = query.text(7);
    job.model_bytes = static_cast<std::uint64_t>(query.number(8));
    job.created_ms = query.number(9);
    job.started_ms = query.maybe_number(10);
    job.finished_ms = query.maybe_number(11);
    job.cancel_at_ms = query.maybe_number(12);
    job.attempt = static_cast<int>(query.number(13));
    job.revision = query.number(14);
    if (const auto error = query.text(15); !error.empty())
        job.error = api::problem_from_json(error);
    job.result = query.text(16);
    job.model = query.text(18);
    job.priority = static_cast<api::JobPriority>(query.number(19));
    job.parts = result_parts_of(query.text(17));
    if (job.finished_ms) {
        job.expires_ms = *job.finished_ms + retention.job_ms;
        if (job.state == JobState::succeeded)
            job.result_expires_ms = *job.finished_ms + retention.result_ms;
    }
    return job;
}

std::optional<JobRow> find_row(SqliteConnection& connection, const std::string& owner,
                               const std::string& id) {
    Query query(connection.prepared(select_row + "WHERE owner = ? AND id = ?"));
    if (!query.bind(owner, id).next()) return std::nullopt;
    return row_of(query);
}

JobRow row_of(SqliteConnection& connection, JobNumber job) {
    Query query(connection.prepared(select_row + "WHERE seq = ?"));
    if (!query.bind(job).next()) throw StoreError("the job " + std::to_string(job) + " is gone");
    return row_of(query);
}

std::optional<JobRow> leased_row(SqliteConnection& connection, const Lease& lease) {
    Query query(connection.prepared(
        select_row + "WHERE seq = ? AND lease_token = ? AND state IN ('running', 'canceling')"));
    if (!query.bind(lease.job, lease.token).next()) return std::nullopt;
    return row_of(query);
}

bool add_delivery(SqliteConnection& connection, const std::string& owner,
                  const std::string& webhook, const api::WebhookMessage& message,
                  int most_pending) {
    return Query(connection.prepared(
                     "INSERT INTO deliveries (id, owner, webhook, receiver, event, payload, "
                     "created_ms, next_ms) SELECT ?1, owner, id, receiver, ?4, ?5, ?6, ?6 "
                     "FROM webhooks w WHERE owner = ?2 AND id = ?3 AND "
                     "(SELECT count(*) FROM deliveries INDEXED BY deliveries_by_receiver WHERE "
                     "owner = ?2 AND receiver = w.receiver AND next_ms IS NOT NULL) < ?7 AND "
                     "(SELECT count(*) FROM deliveries INDEXED BY deliveries_due WHERE owner = ?2 "
                     "AND next_ms IS NOT NULL) < ?8"))
               .bind("msg_" + new_job_id(), owner, webhook, type_of(message), to_json(message),
                     message.at_ms, most_pending, most_pending_of_owner)
               .run() > 0;
}

void add_webhook(SqliteConnection& connection, const Webhook& webhook, const std::string& job) {
    Query(connection.prepared(
              "INSERT INTO webhooks (id, owner, url, secret, events, created_ms, job) "
              "VALUES (?, ?, ?, ?, ?, ?, ?)"))
        .bind(webhook.id, webhook.owner, webhook.url, webhook.secret,
              api::event_names(webhook.events), webhook.created_ms, job)
        .run();
}

void erase_webhook(SqliteConnection& connection, const std::string& owner, const std::string& id) {
    Query(connection.prepared("DELETE FROM deliveries WHERE owner = ? AND webhook = ?"))
        .bind(owner, id)
        .run();
    Query(connection.prepared("DELETE FROM webhooks WHERE owner = ? AND id = ?"))
        .bind(owner, id)
        .run();
}

void note_change(SqliteConnection& connection, const JobRow& row) {
    Query(connection.prepared("INSERT INTO changes VALUES (?, ?, ?, ?, ?)"))
        .bind(row.seq, row.revision, now_ms(), name(row.state), row.attempt)
        .run();
}

/// A message to each webhook of the owner, and to the job's own, that wants it.
void tell_webhooks(SqliteConnection& connection, const JobRow& row,
                   const api::WebhookMessage& message) {
    Query query(
        connection.prepared("SELECT id FROM webhooks INDEXED BY webhooks_by_owner WHERE owner = ?1 "
                            "AND job IN ('', ?2) AND "
                            "instr(' ' || events || ' ', ' ' || ?3 || ' ') > 0"));
    query.bind(row.owner, row.id, type_of(message));
    std::vector<std::string> webhooks;
    while (query.next()) webhooks.push_back(query.text(0));
    for (const std::string& webhook : webhooks)
        (void)add_delivery(connection, row.owner, webhook, message, most_pending_messages);
}

void tell_end(SqliteConnection& connection, const JobRow& row) {
    Query query(connection.prepared("SELECT tag FROM jobs WHERE seq = ?"));
    const std::string tag = query.bind(row.seq).next() ? query.text(0) : "";
    tell_webhooks(connection, row, {now_ms(), api::JobEnded{row.id, row.state, tag, row.batch}});
}

std::map<JobState, std::size_t> batch_states(SqliteConnection& connection, const std::string& owner,
                                             const std::string& id) {
    Query query(connection.prepared(
        "SELECT state, count(*) FROM jobs WHERE batch = ? AND batch <> '' AND owner = ? "
        "GROUP BY state"));
    query.bind(id, owner);
    std::map<JobState, std::size_t> states;
    while (query.next())
        states[state_of(query.text(0))] = static_cast<std::size_t>(query.number(1));
    return states;
}

/// A job of the batch has ended or is gone: it may have been the last, or the last that was left.
void note_batch(SqliteConnection& connection, const JobRow& row) {
    if (row.batch.empty()) return;
    const auto states = batch_states(connection, row.owner, row.batch);
    if (states.empty()) {
        for (const char* sql : {"DELETE FROM batches WHERE owner = ? AND id = ?",
                                "DELETE FROM idempotency WHERE owner = ? AND id = ?"})
            Query(connection.prepared(sql)).bind(row.owner, row.batch).run();
        return;
    }
    for (const auto& [state, jobs] : states) {
        if (!is_final(state)) return;
    }
    const int finished = Query(connection.prepared("UPDATE batches SET finished_ms = ? WHERE owner "
                                                   "= ? AND id = ? AND finished_ms IS NULL"))
                             .bind(now_ms(), row.owner, row.batch)
                             .run();
    if (finished > 0)
        tell_webhooks(connection, row, {now_ms(), api::BatchFinished{row.batch, states}});
}

void charge_worker(SqliteConnection& connection, const JobRow& row) {
    if (row.state != JobState::running && row.state != JobState::canceling) return;
    Query begun(connection.prepared("SELECT started_ms FROM jobs WHERE seq = ?"));
    if (begun.bind(row.seq).next())
        charge_job_turn(connection, row.owner, now_ms() - begun.number(0));
}

void change_state(SqliteConnection& connection, JobRow& row, JobState to,
                  const std::string& reason) {
    if (!may_become(row.state, to)) {
        throw std::logic_error("a job cannot become " + std::string(name(to)) + " from " +
                               std::string(name(row.state)));
    }
    if (to != JobState::canceling) charge_worker(connection, row);
    row.state = to;
    ++row.revision;
    Query(connection.prepared(
              "UPDATE jobs SET state = ?2, revision = ?3, attempt = ?4, "
              "reason = CASE ?5 WHEN '' THEN reason ELSE ?5 END, "
              "started_ms = CASE ?2 WHEN 'running' THEN ?6 WHEN 'queued' THEN NULL "
              "ELSE started_ms END, "
              "finished_ms = CASE WHEN ?2 IN ('succeeded', 'failed', 'canceled') THEN ?6 END, "
              "lease_token = CASE WHEN ?2 = 'canceling' THEN lease_token END, "
              "lease_until_ms = CASE WHEN ?2 = 'canceling' THEN lease_until_ms END "
              "WHERE seq = ?1"))
        .bind(row.seq, name(to), row.revision, row.attempt, reason, now_ms())
        .run();
    note_change(connection, row);
    if (!is_final(to)) return;
    tell_end(connection, row);
    note_batch(connection, row);
}

std::uint64_t bytes_kept(SqliteConnection& connection, const std::string& owner) {
    Query query(connection.prepared("SELECT bytes FROM usage WHERE owner = ?"));
    return query.bind(owner).next() ? static_cast<std::uint64_t>(query.number(0)) : 0;
}

void erase_row(SqliteConnection& connection, const JobRow& row) {
    Query(connection.prepared("DELETE FROM changes WHERE seq = ?")).bind(row.seq).run();
    Query(connection.prepared("DELETE FROM idempotency WHERE owner = ? AND id = ?"))
        .bind(row.owner, row.id)
        .run();
    // A client may choose an id that is a webhook's: only the job's own goes with it.
    Query own(
        connection.prepared("SELECT 1 FROM webhooks WHERE owner = ?1 AND id = ?2 AND job = ?2"));
    if (own.bind(row.owner, row.id).next()) erase_webhook(connection, row.owner, row.id);
    forget_question(connection, row.seq);
    Query(connection.prepared("DELETE FROM jobs WHERE seq = ?")).bind(row.seq).run();
    note_batch(connection, row);
}

}  // namespace lastflat::server
