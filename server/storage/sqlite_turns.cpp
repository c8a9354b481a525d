#include "server/storage/sqlite_turns.h"

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

std::optional<std::string> note_turn(SqliteConnection& connection, const char* what, Query& next) {
    if (!next.next()) return std::nullopt;
    std::string owner = next.text(0);
    Query(connection.prepared("INSERT OR REPLACE INTO turns SELECT ?1, ?2, "
                              "coalesce(max(turn), 0) + 1 FROM turns WHERE what = ?1"))
        .bind(what, owner)
        .run();
    return owner;
}

}  // namespace

std::optional<std::string> take_job_turn(SqliteConnection& connection) {
    Query next(connection.prepared(select_job_owner));
    return note_turn(connection, "job", next.bind(now_ms()));
}

std::optional<std::string> take_delivery_turn(SqliteConnection& connection, int most) {
    Query next(connection.prepared(select_delivery_owner));
    return note_turn(connection, "delivery", next.bind(now_ms(), most));
}

std::size_t queue_position_of(SqliteConnection& connection, std::int64_t job) {
    // Before the job: those of its owner that come first, and as many of each other owner.
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
