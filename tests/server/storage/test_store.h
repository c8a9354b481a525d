// A job store in a folder of its own, and jobs to put into it.
#pragma once

#include "server/storage/sqlite_store.h"
#include "tests/helpers/temporary_folder.h"

namespace lastflat::server::test {

inline NewJob new_job(const std::string& id, const std::string& owner = "") {
    NewJob job;
    job.id = id;
    job.owner = owner;
    job.tag = "tag-" + id;
    job.model = "model-" + id;
    job.request = "{}";
    job.fingerprint = "print-" + id;
    return job;
}

inline JobOutcome success(const std::string& result = "result") {
    JobOutcome outcome;
    outcome.result = result;
    outcome.parts = {{"json", false, 0, 4, "digest"}};
    return outcome;
}

inline JobOutcome failure() {
    JobOutcome outcome;
    outcome.error = "{\"code\":\"broken\",\"detail\":\"it broke\"}";
    return outcome;
}

struct TestStore {
    lastflat::test::TemporaryFolder folder;
    SqliteDatabase database{folder.path() / "jobs.sqlite"};
    SqliteStore store;

    explicit TestStore(const Retention& retention = {}) : store(database, retention) {}

    Admission add(const NewJob& job, const QueueLimits& limits = {}) {
        return store.add(job, limits).admission;
    }
    JobState state(const std::string& id) { return store.find("", id).value().state; }
};

}  // namespace lastflat::server::test
