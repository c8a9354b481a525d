#include "server/storage/sqlite_schema.h"

#include <SQLiteCpp/Transaction.h>

#include <array>
#include <string>

#include "server/support/files.h"

namespace lastflat::server {
namespace {

/// Never edited once released: a change is a further entry.
constexpr std::array migrations{R"sql(
CREATE TABLE jobs (
    seq            INTEGER PRIMARY KEY AUTOINCREMENT,
    id             TEXT NOT NULL UNIQUE,
    owner          TEXT NOT NULL,
    tag            TEXT NOT NULL,
    batch          TEXT NOT NULL,
    state          TEXT NOT NULL CHECK (state IN ('queued', 'running', 'canceling', 'succeeded',
                                                  'failed', 'canceled')),
    reason         TEXT NOT NULL DEFAULT '',
    model          TEXT NOT NULL,
    model_bytes    INTEGER NOT NULL,
    fingerprint    TEXT NOT NULL,
    created_ms     INTEGER NOT NULL,
    started_ms     INTEGER,
    finished_ms    INTEGER,
    cancel_at_ms   INTEGER,
    attempt        INTEGER NOT NULL DEFAULT 0,
    lease_token    INTEGER,
    lease_until_ms INTEGER,
    revision       INTEGER NOT NULL DEFAULT 1,
    error          TEXT NOT NULL DEFAULT '',
    result         TEXT NOT NULL DEFAULT '',
    parts          TEXT NOT NULL DEFAULT '',
    retries        INTEGER NOT NULL DEFAULT 0,
    not_before_ms  INTEGER NOT NULL DEFAULT 0,
    request        TEXT NOT NULL  -- last: it may be long, and what follows a long column is slow
);
CREATE INDEX jobs_by_state ON jobs (state, seq);
CREATE INDEX jobs_by_owner_state ON jobs (state, owner);
CREATE INDEX jobs_by_owner ON jobs (owner, seq);
CREATE INDEX jobs_by_tag ON jobs (tag, seq) WHERE tag <> '';
CREATE INDEX jobs_by_batch ON jobs (batch, seq) WHERE batch <> '';
CREATE INDEX jobs_by_model ON jobs (model);
CREATE INDEX jobs_by_result ON jobs (result) WHERE result <> '';
CREATE INDEX jobs_by_end ON jobs (finished_ms) WHERE finished_ms IS NOT NULL;
CREATE INDEX jobs_with_result ON jobs (finished_ms) WHERE result <> '';
CREATE INDEX jobs_by_deadline ON jobs (cancel_at_ms) WHERE finished_ms IS NULL;

-- Every state that a job has had.
CREATE TABLE changes (
    seq      INTEGER NOT NULL,
    revision INTEGER NOT NULL,
    at_ms    INTEGER NOT NULL,
    state    TEXT NOT NULL,
    attempt  INTEGER NOT NULL,
    PRIMARY KEY (seq, revision)
) WITHOUT ROWID;

CREATE TABLE idempotency (
    owner       TEXT NOT NULL,
    key         TEXT NOT NULL,
    fingerprint TEXT NOT NULL,
    id          TEXT NOT NULL,
    PRIMARY KEY (owner, key)
) WITHOUT ROWID;
CREATE INDEX idempotency_by_id ON idempotency (id);

-- Jobs that were forgotten because their time was over.
CREATE TABLE expired (
    id    TEXT NOT NULL PRIMARY KEY,
    owner TEXT NOT NULL,
    at_ms INTEGER NOT NULL
) WITHOUT ROWID;
CREATE INDEX expired_by_time ON expired (at_ms);

CREATE TABLE assets (
    owner      TEXT NOT NULL,
    digest     TEXT NOT NULL,
    bytes      INTEGER NOT NULL,
    created_ms INTEGER NOT NULL,
    PRIMARY KEY (owner, digest)
) WITHOUT ROWID;
CREATE INDEX assets_by_digest ON assets (digest);

CREATE TABLE keys (
    id         TEXT NOT NULL PRIMARY KEY,
    name       TEXT NOT NULL,
    hash       TEXT NOT NULL UNIQUE,
    created_ms INTEGER NOT NULL,
    revoked_ms INTEGER
) WITHOUT ROWID;

CREATE TABLE secrets (
    name  TEXT NOT NULL PRIMARY KEY,
    value TEXT NOT NULL
) WITHOUT ROWID;
)sql",
                                R"sql(
CREATE TABLE webhooks (
    id         TEXT NOT NULL PRIMARY KEY,
    owner      TEXT NOT NULL,
    url        TEXT NOT NULL,
    secret     TEXT NOT NULL,
    events     TEXT NOT NULL,
    created_ms INTEGER NOT NULL
) WITHOUT ROWID;
CREATE INDEX webhooks_by_owner ON webhooks (owner);

-- Messages to be sent, written together with the change that they tell of.
CREATE TABLE deliveries (
    seq        INTEGER PRIMARY KEY AUTOINCREMENT,
    id         TEXT NOT NULL,
    webhook    TEXT NOT NULL,
    event      TEXT NOT NULL,
    payload    TEXT NOT NULL,
    created_ms INTEGER NOT NULL,
    attempt    INTEGER NOT NULL DEFAULT 0,
    next_ms    INTEGER,
    delivered  INTEGER NOT NULL DEFAULT 0,
    status     INTEGER NOT NULL DEFAULT 0,
    error      TEXT NOT NULL DEFAULT ''
);
CREATE INDEX deliveries_due ON deliveries (next_ms) WHERE next_ms IS NOT NULL;
CREATE INDEX deliveries_by_webhook ON deliveries (webhook, seq);
)sql",
                                R"sql(
-- A webhook for one job has that job's id, in both columns, and goes with it.
ALTER TABLE webhooks ADD COLUMN job TEXT NOT NULL DEFAULT '';
DROP INDEX webhooks_by_owner;
CREATE INDEX webhooks_by_owner ON webhooks (owner, job);
)sql"};

}  // namespace

void migrate(SQLite::Database& database) {
    int version = database.execAndGet("PRAGMA user_version").getInt();
    const int newest = static_cast<int>(migrations.size());
    if (version > newest) {
        throw StoreError("the database has schema " + std::to_string(version) +
                         ", this version of the program knows up to " + std::to_string(newest) +
                         "; use the newer program");
    }
    while (version < newest) {
        SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
        // Another process may have been faster.
        version = database.execAndGet("PRAGMA user_version").getInt();
        if (version >= newest) break;
        database.exec(migrations.at(static_cast<std::size_t>(version)));
        database.exec("PRAGMA user_version=" + std::to_string(++version));
        transaction.commit();
    }
}

}  // namespace lastflat::server
