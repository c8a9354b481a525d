// A job store in a folder of its own, and jobs to put into it.
#pragma once

#include "server/storage/sqlite_store.h"
#include "tests/helpers/temporary_folder.h"

namespace lastflat::server::test {

constexpr std::int64_t long_lease = 60'000;

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

inline Succeeded success(const std::string& result = "result") {
    return {result, {{"json", 0, 4, "digest"}}};
}

inline Failed failure() {
    return {{"solver_failed", "it broke"}};
}

inline const api::Problem lost("worker_lost", "its worker was lost");

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
