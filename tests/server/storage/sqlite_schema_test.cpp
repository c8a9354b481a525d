#include "server/storage/sqlite_schema.h"

#include <doctest/doctest.h>

#include "server/storage/sqlite_rows.h"
#include "tests/server/storage/test_store.h"

namespace lastflat::server {

using test::long_lease;
using test::new_job;

TEST_SUITE("server/storage/sqlite_schema") {
    TEST_CASE("what an earlier program kept is there in this one") {
        lastflat::test::TemporaryFolder folder;
        const auto file = folder.path() / "jobs.sqlite";
        {
            SQLite::Database old(file, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
            migrate(old, 3);
            old.exec(R"sql(
INSERT INTO jobs (seq, id, owner, tag, batch, state, model, model_bytes, fingerprint, created_ms, request)
    VALUES (5, 'A', 'key', 't', 'b', 'queued', 'm', 7, 'f', 1, '{}');
INSERT INTO sqlite_sequence VALUES ('other', 3);
UPDATE sqlite_sequence SET seq = 9 WHERE name = 'jobs';
INSERT INTO jobs (seq, id, owner, tag, batch, state, model, model_bytes, fingerprint, created_ms, finished_ms, result, parts, request)
    VALUES (6, 'R', 'key', '', '', 'succeeded', 'm', 7, 'f', 1, 2, 'blob', '[{"size": 20}, {"size": 3}]', '{}');
INSERT INTO assets VALUES ('key', 'd', 100, 1);
INSERT INTO changes VALUES (5, 1, 1, 'queued', 0);
INSERT INTO idempotency VALUES ('key', 'once', 'f', 'A');
INSERT INTO expired VALUES ('E', 'key', 1);
INSERT INTO webhooks VALUES ('W', 'key', 'https://Example.com:8443?x=/y', 's', 'job.failed', 1, '');
INSERT INTO deliveries (id, webhook, event, payload, created_ms, next_ms)
    VALUES ('msg', 'W', 'job.failed', '{}', 1, 2);
)sql");
        }
        SqliteDatabase database(file);
        SqliteStore store(database, {});
        const JobRecord job = store.find("key", "A").value();
        CHECK(job.batch == "b");
        CHECK(job.model_bytes == 7);
        CHECK(job.priority == api::JobPriority::interactive);
        CHECK(store.find_batch("key", "b")->size == 1);
        CHECK(store.history(job.number, 0).size() == 1);
        CHECK(store.is_expired("key", "E"));
        NewJob again = new_job("other", "key");
        again.idempotency_key = "once";
        again.fingerprint = "f";
        CHECK(store.add(again, {}).admission == Admission::repeated);
        again.idempotency_key.clear();
        REQUIRE(store.add(again, {}).admission == Admission::queued);
        CHECK(store.find("key", "other")->number == 10);  // numbers are never given twice
        CHECK(store.claim(long_lease)->id == "A");
        const std::string receiver = database.read([](SqliteConnection& connection) {
            Query query(connection.prepared("SELECT receiver FROM deliveries WHERE owner = 'key'"));
            return query.next() ? query.text(0) : "";
        });
        CHECK(receiver == "https://example.com:8443");
        const auto bytes = database.read(
            [](SqliteConnection& connection) { return bytes_kept(connection, "key"); });
        CHECK(bytes == 7 + 20 + 3 + 100);
    }

    TEST_CASE("a database of a newer program is left alone") {
        lastflat::test::TemporaryFolder folder;
        { SqliteDatabase database(folder.path() / "jobs.sqlite"); }
        SQLite::Database(folder.path() / "jobs.sqlite", SQLite::OPEN_READWRITE)
            .exec("PRAGMA user_version=99");
        CHECK_THROWS_AS(SqliteDatabase(folder.path() / "jobs.sqlite"), StoreError);
    }
}

}  // namespace lastflat::server
