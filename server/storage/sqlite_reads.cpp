// What is asked of the jobs without changing them.
#include <algorithm>

#include "server/storage/sqlite_answers.h"
#include "server/storage/sqlite_rows.h"
#include "server/storage/sqlite_store.h"
#include "server/storage/sqlite_turns.h"

namespace lastflat::server {
namespace {

const std::string select_record = "SELECT " + std::string(record_columns) + " FROM jobs ";
const std::string select_one = select_record + "WHERE owner = ?1 AND id = ?2";
/// Only the conditions that are asked for: an index serves what the statement says, not what it
/// might have said.
std::string select_list(const std::string& owner, const JobFilter& filter) {
    std::string sql = select_record + "WHERE ?7 > 0";
    if (!owner.empty()) sql += " AND owner = ?1";
    if (filter.state) sql += " AND state = ?2";
    if (filter.tag) sql += " AND tag = ?3 AND tag <> ''";
    if (filter.batch) sql += " AND batch = ?4 AND batch <> ''";
    if (filter.created_after_ms) sql += " AND created_ms > ?5";
    if (filter.before) sql += " AND seq < ?6";
    return sql + " ORDER BY seq DESC LIMIT ?7";
}

}  // namespace

std::optional<JobRecord> SqliteStore::find(const std::string& owner, const std::string& id) {
    return database_.read([&](SqliteConnection& connection) -> std::optional<JobRecord> {
        Query query(connection.prepared(select_one));
        if (!query.bind(owner, id).next()) return std::nullopt;
        JobRecord job = record_of(query, retention_);
        if (job.state == JobState::queued)
            job.queue_position = queue_position_of(connection, job.number);
        return job;
    });
}

std::optional<BatchRecord> SqliteStore::find_batch(const std::string& owner,
                                                   const std::string& id) {
    return database_.read([&](SqliteConnection& connection) -> std::optional<BatchRecord> {
        Query query(connection.prepared(
            "SELECT created_ms, finished_ms, size FROM batches WHERE owner = ? AND id = ?"));
        if (!query.bind(owner, id).next()) return std::nullopt;
        Query jobs(connection.prepared(
            "SELECT sum(revision), min(CASE WHEN finished_ms IS NULL THEN seq END) FROM jobs "
            "WHERE batch = ? AND batch <> '' AND owner = ?"));
        if (!jobs.bind(id, owner).next()) return std::nullopt;
        return BatchRecord{id,
                           owner,
                           query.number(0),
                           query.maybe_number(1),
                           static_cast<std::size_t>(query.number(2)),
                           batch_states(connection, owner, id),
                           jobs.number(0),
                           jobs.maybe_number(1)};
    });
}

std::string SqliteStore::answer(const NewJob& job) {
    return database_.read([&](SqliteConnection& connection) -> std::string {
        const auto answer = answer_to(connection, job);
        return answer ? row_of(connection, *answer).result : std::string();
    });
}

bool SqliteStore::is_expired(const std::string& owner, const std::string& id) {
    return database_.read([&](SqliteConnection& connection) {
        Query query(connection.prepared("SELECT 1 FROM expired WHERE owner = ? AND id = ?"));
        return query.bind(owner, id).next();
    });
}

JobList SqliteStore::list(const std::string& owner, const JobFilter& filter) {
    return database_.read([&](SqliteConnection& connection) {
        std::optional<std::string> state;
        if (filter.state) state = name(*filter.state);
        Query query(connection.prepared(select_list(owner, filter)));
        query.bind(owner, state, filter.tag, filter.batch, filter.created_after_ms, filter.before,
                   static_cast<std::int64_t>(filter.limit + 1));
        JobList list;
        std::optional<QueueOrder> order;  // of the whole queue, once, if any of them waits
        std::int64_t last = 0;
        while (query.next()) {
            if (list.jobs.size() == filter.limit) {
                list.next = last;
                break;
            }
            last = query.number(0);
            list.jobs.push_back(record_of(query, retention_));
            if (list.jobs.back().state != JobState::queued) continue;
            if (!order) order.emplace(connection);
            list.jobs.back().queue_position = order->position_of(last);
        }
        return list;
    });
}

std::vector<StateChange> SqliteStore::history(JobNumber job, std::int64_t after) {
    return database_.read([&](SqliteConnection& connection) {
        Query query(connection.prepared(
            "SELECT revision, at_ms, state, attempt FROM changes WHERE seq = ? AND revision > ? "
            "ORDER BY revision"));
        query.bind(job, after);
        std::vector<StateChange> changes;
        while (query.next()) {
            changes.push_back({query.number(0), query.number(1), state_of(query.text(2)),
                               static_cast<int>(query.number(3))});
        }
        return changes;
    });
}

JobCounts SqliteStore::counts() {
    return database_.read([](SqliteConnection& connection) {
        Query query(connection.prepared(
            "SELECT state, count(*), min(created_ms) FROM jobs "
            "WHERE state IN ('queued', 'running', 'canceling') GROUP BY state"));
        JobCounts counts;
        while (query.next()) {
            const auto jobs = static_cast<std::size_t>(query.number(1));
            if (query.text(0) == "queued") {
                counts.queued = jobs;
                counts.oldest_queued_ms = query.number(2);
            } else {
                counts.running += jobs;
            }
        }
        return counts;
    });
}

bool SqliteStore::needs_blob(const std::string& digest) {
    return database_.read([&](SqliteConnection& connection) {
        Query query(connection.prepared(
            "SELECT 1 FROM jobs WHERE model = ?1 AND state IN ('queued', 'running', 'canceling') "
            "UNION ALL SELECT 1 FROM jobs WHERE result = ?1 AND result <> '' "
            "UNION ALL SELECT 1 FROM assets WHERE digest = ?1 LIMIT 1"));
        return query.bind(digest).next();
    });
}

bool SqliteStore::has_blob(const std::string& owner, const std::string& digest) {
    return database_.read([&](SqliteConnection& connection) {
        Query query(connection.prepared(
            "SELECT 1 FROM jobs WHERE model = ?1 AND owner = ?2 "
            "AND state IN ('queued', 'running', 'canceling') "
            "UNION ALL SELECT 1 FROM assets WHERE owner = ?2 AND digest = ?1 LIMIT 1"));
        return query.bind(digest, owner).next();
    });
}

}  // namespace lastflat::server
