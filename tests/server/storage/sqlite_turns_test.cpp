#include "server/storage/sqlite_turns.h"

#include <doctest/doctest.h>

#include "tests/server/storage/test_store.h"

namespace lastflat::server {

using test::failure;
using test::long_lease;
using test::new_job;
using test::TestStore;

TEST_SUITE("server/storage/sqlite_turns") {
    TEST_CASE("owners take turns, whoever was first and however many jobs they have") {
        TestStore s;
        for (int i = 0; i < 6; ++i)
            REQUIRE(s.add(new_job("A" + std::to_string(i), "one")) == Admission::queued);
        REQUIRE(s.add(new_job("B0", "two")) == Admission::queued);
        REQUIRE(s.add(new_job("B1", "two")) == Admission::queued);
        REQUIRE(s.add(new_job("C0", "three")) == Admission::queued);
        CHECK(s.store.find("one", "A0")->queue_position == 3);  // at the latest
        CHECK(s.store.find("one", "A5")->queue_position == 9);
        CHECK(s.store.find("three", "C0")->queue_position == 3);
        CHECK(s.store.find("two", "B1")->queue_position == 5);
        for (const JobRecord& job : s.store.list("", {}).jobs)
            CHECK(job.queue_position == s.store.find(job.owner, job.id)->queue_position);
        std::string order;
        while (const auto claim = s.store.claim(long_lease)) {
            order += claim->id + " ";
            REQUIRE(s.store.finish(claim->lease, failure()));
        }
        CHECK(order == "A0 C0 B0 A1 B1 A2 A3 A4 A5 ");
    }

    TEST_CASE("who has fewer jobs running is next") {
        TestStore s;
        for (const char* id : {"A0", "A1", "A2"})
            REQUIRE(s.add(new_job(id, "one")) == Admission::queued);
        CHECK(s.store.claim(long_lease)->id == "A0");
        CHECK(s.store.claim(long_lease)->id == "A1");
        REQUIRE(s.add(new_job("B0", "two")) == Admission::queued);
        REQUIRE(s.add(new_job("B1", "two")) == Admission::queued);
        CHECK(s.store.claim(long_lease)->id == "B0");
        CHECK(s.store.claim(long_lease)->id == "B1");  // one against two
        CHECK(s.store.claim(long_lease)->id == "A2");
    }

    TEST_CASE("who has used workers longer waits longer, and who was away has saved nothing up") {
        TestStore s;
        for (int i = 0; i < 4; ++i) {
            REQUIRE(s.add(new_job("A" + std::to_string(i), "one")) == Admission::queued);
            REQUIRE(s.add(new_job("B" + std::to_string(i), "two")) == Admission::queued);
        }
        const auto run_one = [&](std::int64_t ms) {
            const Claim claim = s.store.claim(long_lease).value();
            s.database.write([&](SqliteConnection& connection) {
                Query(
                    connection.prepared("UPDATE jobs SET started_ms = started_ms - ? WHERE id = ?"))
                    .bind(ms, claim.id)
                    .run();
            });
            REQUIRE(s.store.finish(claim.lease, failure()));
            return claim.id;
        };
        CHECK(run_one(250) == "A0");
        CHECK(run_one(0) == "B0");
        CHECK(run_one(0) == "B1");
        CHECK(run_one(10'000) == "B2");
        REQUIRE(s.add(new_job("C0", "three")) == Admission::queued);
        REQUIRE(s.add(new_job("C1", "three")) == Admission::queued);
        for (const char* next : {"A1", "C0", "A2", "C1", "A3"}) CHECK(run_one(0) == next);
        CHECK(run_one(0) == "B3");
    }

    TEST_CASE("an owner whose jobs are all put off keeps nobody waiting") {
        TestStore s;
        REQUIRE(s.add(new_job("A", "one")) == Admission::queued);
        REQUIRE(s.store.release(s.store.claim(long_lease)->lease, Release::later));
        REQUIRE(s.add(new_job("B", "two")) == Admission::queued);
        CHECK(s.store.claim(long_lease)->id == "B");
        CHECK_FALSE(s.store.claim(long_lease).has_value());
    }

    TEST_CASE("what somebody waits for goes first among the jobs of its owner, and only there") {
        TestStore s;
        const auto asked = [](const char* id, const char* owner, api::JobPriority priority) {
            NewJob job = new_job(id, owner);
            job.priority = priority;
            return job;
        };
        using enum api::JobPriority;
        for (const NewJob& j : {asked("A0", "one", batch), asked("A1", "one", interactive),
                                asked("A2", "one", interactive), asked("B0", "two", batch)})
            REQUIRE(s.add(j) == Admission::queued);
        CHECK(s.store.find("one", "A0")->queue_position == 4);
        CHECK(s.store.find("one", "A1")->queue_position == 2);
        CHECK(s.store.find("one", "A0")->priority == batch);
        std::string order;
        while (const auto claim = s.store.claim(long_lease)) order += claim->id + " ";
        CHECK(order == "A1 B0 A2 A0 ");
    }
}

}  // namespace lastflat::server
