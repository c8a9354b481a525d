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
)sql",
                                R"sql(
-- Ids are unique among their owner's alone: tables whose ids were everybody's are made anew.
CREATE TABLE jobs_of_owners (
    seq            INTEGER PRIMARY KEY AUTOINCREMENT,
    id             TEXT NOT NULL,
    owner          TEXT NOT NULL,
    tag            TEXT NOT NULL,
    batch          TEXT NOT NULL,
    priority       INTEGER NOT NULL DEFAULT 1,  -- 0 batch, 1 interactive
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
    result_bytes   INTEGER NOT NULL DEFAULT 0,
    retries        INTEGER NOT NULL DEFAULT 0,
    not_before_ms  INTEGER NOT NULL DEFAULT 0,
    request        TEXT NOT NULL,  -- last: it may be long, and what follows a long column is slow
    UNIQUE (owner, id)
);
INSERT INTO jobs_of_owners SELECT seq, id, owner, tag, batch, 1, state, reason, model, model_bytes,
    fingerprint, created_ms, started_ms, finished_ms, cancel_at_ms, attempt, lease_token,
    lease_until_ms, revision, error, result, parts,
    CASE parts WHEN '' THEN 0
        ELSE (SELECT coalesce(sum(json_extract(value, '$.size')), 0) FROM json_each(parts)) END,
    retries, not_before_ms, request FROM jobs;
INSERT OR REPLACE INTO sqlite_sequence (rowid, name, seq)
    SELECT (SELECT rowid FROM sqlite_sequence WHERE name = 'jobs_of_owners'), 'jobs_of_owners', seq
    FROM sqlite_sequence WHERE name = 'jobs';
DROP TABLE jobs;
ALTER TABLE jobs_of_owners RENAME TO jobs;
CREATE INDEX jobs_by_state ON jobs (state, seq);
CREATE INDEX jobs_by_owner_state ON jobs (state, owner);
CREATE INDEX jobs_in_order ON jobs (owner, priority DESC, seq) WHERE state = 'queued';
CREATE INDEX jobs_by_owner ON jobs (owner, seq);
CREATE INDEX jobs_by_tag ON jobs (tag, seq) WHERE tag <> '';
CREATE INDEX jobs_by_batch ON jobs (batch, seq) WHERE batch <> '';
CREATE INDEX jobs_by_model ON jobs (model);
CREATE INDEX jobs_by_result ON jobs (result) WHERE result <> '';
CREATE INDEX jobs_by_end ON jobs (finished_ms) WHERE finished_ms IS NOT NULL;
CREATE INDEX jobs_with_result ON jobs (finished_ms) WHERE result <> '';
CREATE INDEX jobs_by_deadline ON jobs (cancel_at_ms) WHERE finished_ms IS NULL;

DROP INDEX idempotency_by_id;
CREATE INDEX idempotency_by_id ON idempotency (owner, id);

CREATE TABLE expired_of_owners (
    owner TEXT NOT NULL,
    id    TEXT NOT NULL,
    at_ms INTEGER NOT NULL,
    PRIMARY KEY (owner, id)
) WITHOUT ROWID;
INSERT INTO expired_of_owners SELECT owner, id, at_ms FROM expired;
DROP TABLE expired;
ALTER TABLE expired_of_owners RENAME TO expired;
CREATE INDEX expired_by_time ON expired (at_ms);

CREATE TABLE webhooks_of_owners (
    owner      TEXT NOT NULL,
    id         TEXT NOT NULL,
    url        TEXT NOT NULL,
    secret     TEXT NOT NULL,
    events     TEXT NOT NULL,
    created_ms INTEGER NOT NULL,
    job        TEXT NOT NULL,  -- of a single job: its id, which is this one's too; else empty
    -- scheme, host and port
    receiver   TEXT NOT NULL GENERATED ALWAYS AS (lower(substr(url, 1, instr(url, '://') + 1 +
        instr(replace(replace(substr(url, instr(url, '://') + 3), '?', '/'), '#', '/') || '/',
              '/')))) STORED,
    PRIMARY KEY (owner, id)
) WITHOUT ROWID;
INSERT INTO webhooks_of_owners SELECT owner, id, url, secret, events, created_ms, job FROM webhooks;

CREATE TABLE deliveries_of_owners (
    seq            INTEGER PRIMARY KEY AUTOINCREMENT,
    id             TEXT NOT NULL,
    owner          TEXT NOT NULL,
    webhook        TEXT NOT NULL,
    receiver       TEXT NOT NULL,
    event          TEXT NOT NULL,
    payload        TEXT NOT NULL,
    created_ms     INTEGER NOT NULL,
    attempt        INTEGER NOT NULL DEFAULT 0,
    next_ms        INTEGER,
    lease_until_ms INTEGER,  -- while it is being sent
    delivered      INTEGER NOT NULL DEFAULT 0,
    status         INTEGER NOT NULL DEFAULT 0,
    error          TEXT NOT NULL DEFAULT ''
);
INSERT INTO deliveries_of_owners SELECT d.seq, d.id, w.owner, d.webhook, w.receiver, d.event,
    d.payload, d.created_ms, d.attempt, d.next_ms, NULL, d.delivered, d.status, d.error
    FROM deliveries d JOIN webhooks_of_owners w ON w.id = d.webhook;
DROP TABLE deliveries;
DROP TABLE webhooks;
ALTER TABLE webhooks_of_owners RENAME TO webhooks;
ALTER TABLE deliveries_of_owners RENAME TO deliveries;
CREATE INDEX webhooks_by_owner ON webhooks (owner, job);
CREATE INDEX deliveries_due ON deliveries (owner, next_ms) WHERE next_ms IS NOT NULL;
CREATE INDEX deliveries_by_receiver ON deliveries (owner, receiver) WHERE next_ms IS NOT NULL;
CREATE INDEX deliveries_in_flight ON deliveries (owner) WHERE lease_until_ms IS NOT NULL;
CREATE INDEX deliveries_by_webhook ON deliveries (owner, webhook, seq);

-- Receivers that do not answer, until they do.
CREATE TABLE silent_receivers (
    owner    TEXT NOT NULL,
    receiver TEXT NOT NULL,
    failures INTEGER NOT NULL,
    PRIMARY KEY (owner, receiver)
) WITHOUT ROWID;

-- Bytes of an owner's models that are still needed, results and assets, each as often as it is used.
CREATE TABLE usage (
    owner TEXT NOT NULL PRIMARY KEY,
    bytes INTEGER NOT NULL
) WITHOUT ROWID;
CREATE VIEW kept (owner, bytes) AS
    SELECT owner, model_bytes FROM jobs WHERE state IN ('queued', 'running', 'canceling')
    UNION ALL SELECT owner, result_bytes FROM jobs WHERE result <> ''
    UNION ALL SELECT owner, bytes FROM assets;
INSERT INTO usage SELECT owner, sum(bytes) FROM kept GROUP BY owner;
CREATE TRIGGER job_added AFTER INSERT ON jobs BEGIN
    INSERT INTO usage VALUES (new.owner, new.model_bytes)
        ON CONFLICT (owner) DO UPDATE SET bytes = bytes + excluded.bytes;
END;
CREATE TRIGGER job_changed AFTER UPDATE OF state, result, result_bytes ON jobs BEGIN
    UPDATE usage SET bytes = bytes
        + CASE WHEN new.state IN ('queued', 'running', 'canceling') THEN new.model_bytes ELSE 0 END
        - CASE WHEN old.state IN ('queued', 'running', 'canceling') THEN old.model_bytes ELSE 0 END
        + CASE new.result WHEN '' THEN 0 ELSE new.result_bytes END
        - CASE old.result WHEN '' THEN 0 ELSE old.result_bytes END
        WHERE owner = new.owner;
END;
CREATE TRIGGER job_removed AFTER DELETE ON jobs BEGIN
    UPDATE usage SET bytes = bytes
        - CASE WHEN old.state IN ('queued', 'running', 'canceling') THEN old.model_bytes ELSE 0 END
        - CASE old.result WHEN '' THEN 0 ELSE old.result_bytes END
        WHERE owner = old.owner;
END;
CREATE TRIGGER asset_added AFTER INSERT ON assets BEGIN
    INSERT INTO usage VALUES (new.owner, new.bytes)
        ON CONFLICT (owner) DO UPDATE SET bytes = bytes + excluded.bytes;
END;
CREATE TRIGGER asset_removed AFTER DELETE ON assets BEGIN
    UPDATE usage SET bytes = bytes - old.bytes WHERE owner = old.owner;
END;

-- Whose turn it is: the least. Of jobs, ms of workers that an owner has used; of messages, a number
-- that grows with every turn.
CREATE TABLE turns (
    what  TEXT NOT NULL,
    owner TEXT NOT NULL,
    turn  INTEGER NOT NULL,
    PRIMARY KEY (what, owner)
) WITHOUT ROWID;
)sql",
                                R"sql(
CREATE TABLE batches (
    owner       TEXT NOT NULL,
    id          TEXT NOT NULL,
    created_ms  INTEGER NOT NULL,
    finished_ms INTEGER,
    size        INTEGER NOT NULL,
    PRIMARY KEY (owner, id)
) WITHOUT ROWID;
INSERT INTO batches SELECT owner, batch, min(created_ms),
    CASE WHEN count(*) = count(finished_ms) THEN max(finished_ms) END, count(*)
    FROM jobs WHERE batch <> '' GROUP BY owner, batch;
)sql",
                                R"sql(
-- What a job's result depends on: who asks the same again has the answer at once.
CREATE TABLE questions (
    seq      INTEGER PRIMARY KEY,
    owner    TEXT NOT NULL,
    question TEXT NOT NULL
);
CREATE INDEX questions_by_text ON questions (owner, question, seq);
)sql",
                                R"sql(
ALTER TABLE keys ADD COLUMN scope TEXT NOT NULL DEFAULT 'all';
ALTER TABLE keys ADD COLUMN expires_ms INTEGER;
)sql",
                                R"sql(
-- A result that answers several jobs of an owner is kept once, and counts once.
DROP TRIGGER job_changed;
DROP TRIGGER job_removed;
DROP VIEW kept;
CREATE VIEW kept (owner, bytes) AS
    SELECT owner, model_bytes FROM jobs WHERE state IN ('queued', 'running', 'canceling')
    UNION ALL SELECT owner, max(result_bytes) FROM jobs WHERE result <> '' GROUP BY owner, result
    UNION ALL SELECT owner, bytes FROM assets;
UPDATE usage SET bytes = (SELECT coalesce(sum(k.bytes), 0) FROM kept k WHERE k.owner = usage.owner);
CREATE TRIGGER job_changed AFTER UPDATE OF state, result, result_bytes ON jobs BEGIN
    UPDATE usage SET bytes = bytes
        + CASE WHEN new.state IN ('queued', 'running', 'canceling') THEN new.model_bytes ELSE 0 END
        - CASE WHEN old.state IN ('queued', 'running', 'canceling') THEN old.model_bytes ELSE 0 END
        + CASE WHEN new.result = '' OR EXISTS (SELECT 1 FROM jobs WHERE result = new.result
            AND owner = new.owner AND seq <> new.seq) THEN 0 ELSE new.result_bytes END
        - CASE WHEN old.result = '' OR EXISTS (SELECT 1 FROM jobs WHERE result = old.result
            AND owner = old.owner AND seq <> old.seq) THEN 0 ELSE old.result_bytes END
        WHERE owner = new.owner;
END;
CREATE TRIGGER job_removed AFTER DELETE ON jobs BEGIN
    UPDATE usage SET bytes = bytes
        - CASE WHEN old.state IN ('queued', 'running', 'canceling') THEN old.model_bytes ELSE 0 END
        - CASE WHEN old.result = '' OR EXISTS (SELECT 1 FROM jobs WHERE result = old.result
            AND owner = old.owner) THEN 0 ELSE old.result_bytes END
        WHERE owner = old.owner;
END;
)sql"};

}  // namespace

static_assert(migrations.size() == newest_schema);

void migrate(SQLite::Database& database, int wanted) {
    int schema = database.execAndGet("PRAGMA user_version").getInt();
    if (schema > newest_schema) {
        throw StoreError("the database has schema " + std::to_string(schema) +
                         ", this version of the program knows up to " +
                         std::to_string(newest_schema) + "; use the newer program");
    }
    while (schema < wanted) {
        SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
        // Another process may have been faster.
        schema = database.execAndGet("PRAGMA user_version").getInt();
        if (schema >= wanted) break;
        database.exec(migrations.at(static_cast<std::size_t>(schema)));
        database.exec("PRAGMA user_version=" + std::to_string(++schema));
        transaction.commit();
    }
}

}  // namespace lastflat::server
