#include "server/storage/sqlite_turns.h"

#include <algorithm>

#include "server/support/clock.h"

namespace lastflat::server {
namespace {

/// Each owner of rows that `condition` selects is found by one look into an index on the owner,
/// however many rows there are.
std::string waiting_owners(const std::string& table, const std::string& condition) {
    const std::string rows = " FROM " + table + " WHERE " + condition;
    return "WITH RECURSIVE waiting (owner) AS (SELECT min(owner)" + rows +
           " UNION ALL SELECT (SELECT min(owner)" + rows +
           " AND owner > waiting.owner) FROM waiting WHERE waiting.owner IS NOT NULL) ";
}

const std::string select_job_owner =
    waiting_owners("jobs", "state = 'queued'") +
    "SELECT w.owner FROM waiting w LEFT JOIN turns t ON t.what = 'job' AND t.owner = w.owner "
    "WHERE EXISTS (SELECT 1 FROM jobs WHERE state = 'queued' AND owner = w.owner "
    "AND not_before_ms <= ?1) "
    "ORDER BY (SELECT count(*) FROM jobs WHERE state IN ('running', 'canceling') "
    "AND owner = w.owner), coalesce(t.turn, 0), w.owner LIMIT 1";

const std::string select_delivery_owner =
    waiting_owners("deliveries", "next_ms IS NOT NULL") +
    ", sending (owner, messages) AS (SELECT owner, count(*) FROM deliveries "
    "WHERE lease_until_ms IS NOT NULL AND lease_until_ms > ?1 GROUP BY owner) "
    "SELECT w.owner FROM waiting w LEFT JOIN sending s ON s.owner = w.owner "
    "LEFT JOIN turns t ON t.what = 'delivery' AND t.owner = w.owner "
    "WHERE coalesce(s.messages, 0) < ?2 "
    "AND EXISTS (SELECT 1 FROM deliveries WHERE owner = w.owner AND next_ms <= ?1) "
    "ORDER BY coalesce(s.messages, 0), coalesce(t.turn, 0), w.owner LIMIT 1";

/// What a turn costs at least, in ms of a worker: even jobs that take no time are no reason to let
/// others wait.
constexpr std::int64_t least_cost_ms = 100;

}  // namespace

void enter_job_turns(SqliteConnection& connection, const std::string& owner) {
    Query active(connection.prepared(
        "SELECT 1 FROM jobs WHERE state IN ('queued', 'running', 'canceling') AND owner = ?"));
    if (active.bind(owner).next()) return;
    Query(connection.prepared(
              "INSERT OR REPLACE INTO turns SELECT 'job', ?1, max("
              "coalesce((SELECT turn FROM turns WHERE what = 'job' AND owner = ?1), 0), "
              "coalesce((SELECT min(turn) FROM turns t WHERE what = 'job' AND EXISTS (SELECT 1 "
              "FROM jobs WHERE state IN ('queued', 'running', 'canceling') AND owner = t.owner)), "
              "0))"))
        .bind(owner)
        .run();
}

std::optional<std::string> take_job_turn(SqliteConnection& connection) {
    Query next(connection.prepared(select_job_owner));
    if (!next.bind(now_ms()).next()) return std::nullopt;
    std::string owner = next.text(0);
    Query(connection.prepared("INSERT INTO turns VALUES ('job', ?1, ?2) ON CONFLICT (what, owner) "
                              "DO UPDATE SET turn = turn + excluded.turn"))
        .bind(owner, least_cost_ms)
        .run();
    return owner;
}

void charge_job_turn(SqliteConnection& connection, const std::string& owner, std::int64_t used_ms) {
    if (used_ms <= least_cost_ms) return;
    Query(connection.prepared("UPDATE turns SET turn = turn + ? WHERE what = 'job' AND owner = ?"))
        .bind(used_ms - least_cost_ms, owner)
        .run();
}

std::optional<std::string> take_delivery_turn(SqliteConnection& connection, int most) {
    Query next(connection.prepared(select_delivery_owner));
    if (!next.bind(now_ms(), most).next()) return std::nullopt;
    std::string owner = next.text(0);
    Query(connection.prepared("INSERT OR REPLACE INTO turns SELECT 'delivery', ?1, "
                              "coalesce(max(turn), 0) + 1 FROM turns WHERE what = 'delivery'"))
        .bind(owner)
        .run();
    return owner;
}

QueueOrder::QueueOrder(SqliteConnection& connection) {
    Query query(connection.prepared(
        "SELECT owner, seq FROM jobs WHERE state = 'queued' ORDER BY owner, priority DESC, seq"));
    std::string owner;
    while (query.next()) {
        if (waiting_.empty() || query.text(0) != owner) {
            owner = query.text(0);
            waiting_.push_back(0);
        }
        places_[query.number(1)] = {waiting_.size() - 1, ++waiting_.back()};
    }
}

std::size_t QueueOrder::position_of(std::int64_t job) const {
    const auto found = places_.find(job);
    if (found == places_.end()) return 0;
    // Before the job: those of its owner that come first, and as many of each other owner.
    std::size_t position = found->second.place;
    for (std::size_t owner = 0; owner < waiting_.size(); ++owner) {
        if (owner != found->second.owner)
            position += std::min(waiting_[owner], found->second.place);
    }
    return position;
}

std::size_t queue_position_of(SqliteConnection& connection, std::int64_t job) {
    Query query(connection.prepared(
        "WITH mine AS (SELECT j.owner, (SELECT count(*) FROM jobs o WHERE o.state = 'queued' "
        "AND o.owner = j.owner AND (o.priority, -o.seq) >= (j.priority, -j.seq)) AS place "
        "FROM jobs j WHERE j.seq = ?1) "
        "SELECT m.place + coalesce((SELECT sum(min(waiting, m.place)) FROM (SELECT count(*) AS "
        "waiting FROM jobs WHERE state = 'queued' AND owner <> m.owner GROUP BY owner)), 0) "
        "FROM mine m"));
    return query.bind(job).next() ? static_cast<std::size_t>(query.number(0)) : 0;
}

}  // namespace lastflat::server
