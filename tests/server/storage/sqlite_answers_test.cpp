#include <doctest/doctest.h>

#include "server/storage/sqlite_rows.h"
#include "tests/server/storage/test_store.h"

namespace lastflat::server {

using test::long_lease;
using test::success;
using test::TestStore;

namespace {

NewJob asking(const std::string& id, const std::string& question, const std::string& owner = "") {
    NewJob job = test::new_job(id, owner);
    job.question = question;
    job.model_bytes = 10;
    return job;
}

/// Runs the next queued job to its end.
void run_next(TestStore& s, const std::string& result) {
    const Claim claim = s.store.claim(long_lease).value();
    REQUIRE(s.store.finish(claim.lease, success(result)) == JobState::succeeded);
}

}  // namespace

TEST_SUITE("server/storage/sqlite_answers") {
    TEST_CASE("who asks the same again has the result at once, under an id of its own") {
        TestStore s;
        REQUIRE(s.add(asking("A", "why")) == Admission::queued);
        REQUIRE(s.add(asking("B", "why")) == Admission::queued);
        CHECK(s.state("B") == JobState::queued);  // nothing is there yet
        run_next(s, "because");
        REQUIRE(s.add(asking("C", "why")) == Admission::queued);
        const JobRecord answered = s.store.find("", "C").value();
        CHECK(answered.state == JobState::succeeded);
        CHECK(answered.result == "because");
        CHECK(answered.parts.size() == 1);
        CHECK(answered.attempt == 0);
        CHECK(answered.finished_ms.has_value());
        CHECK_FALSE(answered.started_ms.has_value());
        CHECK(s.store.history(answered.number, 0).size() == 2);

        CHECK(s.store.claim(long_lease)->id == "B");
        REQUIRE(s.add(asking("D", "why not")) == Admission::queued);
        CHECK(s.state("D") == JobState::queued);
    }

    TEST_CASE("what is asked to be run is run, and answers from then on") {
        TestStore s;
        REQUIRE(s.add(asking("A", "why")) == Admission::queued);
        run_next(s, "first");
        NewJob fresh = asking("B", "why");
        fresh.fresh = true;
        CHECK(s.store.answer(fresh).empty());
        REQUIRE(s.add(fresh) == Admission::queued);
        CHECK(s.state("B") == JobState::queued);
        run_next(s, "second");
        CHECK(s.store.answer(asking("C", "why")) == "second");
    }

    TEST_CASE("an answer is the owner's own, and goes with its job or its result") {
        TestStore s({0, 1'000'000});  // results are not kept
        REQUIRE(s.add(asking("A", "why", "alice")) == Admission::queued);
        run_next(s, "because");
        CHECK(s.store.answer(asking("B", "why", "alice")) == "because");
        CHECK(s.store.answer(asking("B", "why", "bob")).empty());
        (void)s.store.sweep(false, test::lost);
        CHECK(s.store.answer(asking("B", "why", "alice")).empty());

        TestStore other;
        REQUIRE(other.add(asking("A", "why")) == Admission::queued);
        run_next(other, "because");
        REQUIRE(other.add(asking("B", "why")) == Admission::queued);
        (void)other.store.remove("", "A");
        CHECK(other.store.needs_blob("because"));
        CHECK(other.store.answer(asking("C", "why")) == "because");
        (void)other.store.remove("", "B");
        CHECK(other.store.answer(asking("C", "why")).empty());
        CHECK_FALSE(other.store.needs_blob("because"));
    }

    TEST_CASE("it needs no place in the queue; a result that several jobs have counts once") {
        TestStore s;
        REQUIRE(s.add(asking("A", "why", "alice")) == Admission::queued);
        run_next(s, "because");
        QueueLimits limits;
        limits.queued_of_owner = 0;
        CHECK(s.add(asking("B", "other", "alice"), limits) == Admission::owner_queue_full);
        CHECK(s.add(asking("C", "why", "alice"), limits) == Admission::queued);
        limits.bytes_of_owner = 3;
        CHECK(s.add(asking("D", "why", "alice"), limits) == Admission::storage_full);
        const auto kept = [&] {
            return s.database.read(
                [](SqliteConnection& connection) { return bytes_kept(connection, "alice"); });
        };
        CHECK(kept() == 4);
        (void)s.store.remove("alice", "A");
        CHECK(kept() == 4);
        (void)s.store.remove("alice", "C");
        CHECK(kept() == 0);
        CHECK(s.database.integrity() == "ok");
    }

    TEST_CASE("a batch whose jobs are all answered has finished") {
        TestStore s;
        REQUIRE(s.add(asking("A", "why")) == Admission::queued);
        run_next(s, "because");
        NewBatch batch{"batch", "", "print", "", {asking("B", "why"), asking("C", "why")}};
        for (NewJob& job : batch.jobs) job.batch = "batch";
        REQUIRE(s.store.add(batch, {}).admission == Admission::queued);
        const BatchRecord answered = s.store.find_batch("", "batch").value();
        CHECK(answered.finished_ms.has_value());
        CHECK(answered.states.at(JobState::succeeded) == 2);

        NewBatch mixed{"mixed", "", "print2", "", {asking("D", "why"), asking("E", "new")}};
        for (NewJob& job : mixed.jobs) job.batch = "mixed";
        REQUIRE(s.store.add(mixed, {}).admission == Admission::queued);
        CHECK_FALSE(s.store.find_batch("", "mixed")->finished_ms.has_value());
        run_next(s, "new");
        CHECK(s.store.find_batch("", "mixed")->finished_ms.has_value());
    }
}

}  // namespace lastflat::server
