#include "server/storage/sqlite_store.h"

#include <doctest/doctest.h>

#include <atomic>
#include <set>
#include <thread>

#include "server/storage/sqlite_accounts.h"
#include "server/support/clock.h"
#include "tests/helpers/eventually.h"
#include "tests/server/storage/test_store.h"

namespace lastflat::server {

using lastflat::test::eventually;
using test::failure;
using test::long_lease;
using test::new_job;
using test::success;
using test::TestStore;

TEST_SUITE("server/jobs/job_state") {
    TEST_CASE("a finished job never changes again") {
        for (const JobState from : {JobState::succeeded, JobState::failed, JobState::canceled}) {
            for (int to = 0; to < 6; ++to) CHECK_FALSE(may_become(from, static_cast<JobState>(to)));
        }
        CHECK_FALSE(may_become(JobState::queued, JobState::failed));
        CHECK_FALSE(may_become(JobState::canceling, JobState::succeeded));
    }
}

TEST_SUITE("server/storage/sqlite_store") {
    TEST_CASE("jobs are claimed oldest first, and their places are told") {
        TestStore s;
        REQUIRE(s.add(new_job("A")) == Admission::queued);
        REQUIRE(s.add(new_job("B")) == Admission::queued);
        CHECK(s.store.find("", "B")->queue_position == 2);
        const auto claim = s.store.claim(long_lease);
        REQUIRE(claim.has_value());
        CHECK(claim->id == "A");
        CHECK(claim->model == "model-A");
        CHECK(claim->attempt == 1);
        CHECK(s.state("A") == JobState::running);
        CHECK(s.store.find("", "B")->queue_position == 1);
        CHECK(s.store.claim(long_lease)->id == "B");
        CHECK_FALSE(s.store.claim(long_lease).has_value());
        CHECK(s.store.counts().running == 2);
    }

    TEST_CASE("everything of a job survives its end and a new start") {
        TestStore s;
        REQUIRE(s.add(new_job("A", "key")) == Admission::queued);
        const auto claim = s.store.claim(long_lease).value();
        CHECK(s.store.finish(claim.lease, success()) == JobState::succeeded);
        SqliteDatabase again(s.folder.path() / "jobs.sqlite");
        SqliteStore store(again, {});
        const JobRecord job = store.find("key", "A").value();
        CHECK(job.state == JobState::succeeded);
        CHECK(job.result == "result");
        REQUIRE(job.parts.size() == 1);
        CHECK(job.parts[0].format == "json");
        CHECK(job.tag == "tag-A");
        CHECK(job.finished_ms >= job.started_ms);
        CHECK(job.result_expires_ms < job.expires_ms);
        std::string states;
        for (const StateChange& change : store.history(job.number, 0))
            states += std::string(name(change.state)) + " ";
        CHECK(states == "queued running succeeded ");
        CHECK(store.history(job.number, 2).size() == 1);
    }

    TEST_CASE("a lost lease can change nothing") {
        TestStore s;
        REQUIRE(s.add(new_job("A")) == Admission::queued);
        const auto first = s.store.claim(0).value();  // over at once
        CHECK(s.store.sweep(false, test::lost).changed == std::vector<JobNumber>{first.lease.job});
        CHECK(s.state("A") == JobState::queued);
        CHECK(s.store.renew(first.lease, long_lease) == Hold::lost);
        const auto second = s.store.claim(long_lease).value();
        CHECK(second.attempt == 2);
        CHECK_FALSE(s.store.finish(first.lease, success("stale")).has_value());
        CHECK_FALSE(s.store.release(first.lease, Release::lost).has_value());
        CHECK(s.state("A") == JobState::running);
        CHECK(s.store.renew(second.lease, long_lease) == Hold::held);
        CHECK(s.store.finish(second.lease, success("fresh")) == JobState::succeeded);
        CHECK(s.store.find("", "A")->result == "fresh");
    }

    TEST_CASE("a job whose worker is lost three times fails and says so") {
        TestStore s;
        REQUIRE(s.add(new_job("A")) == Admission::queued);
        for (int attempt = 1; attempt <= most_attempts; ++attempt) {
            CHECK(s.state("A") == JobState::queued);
            CHECK(s.store.claim(long_lease)->attempt == attempt);
            (void)s.store.sweep(true, test::lost);
        }
        const JobRecord job = s.store.find("", "A").value();
        CHECK(job.state == JobState::failed);
        CHECK(to_json(job.error.value()) == to_json(test::lost));
        CHECK_FALSE(s.store.claim(long_lease).has_value());
    }

    TEST_CASE("a job given back does not lose an attempt, unless it is to") {
        TestStore s;
        REQUIRE(s.add(new_job("A")) == Admission::queued);
        for (int i = 0; i < 5; ++i) {
            const auto claim = s.store.claim(long_lease).value();
            CHECK(claim.attempt == 1);
            CHECK(s.store.release(claim.lease, Release::unfinished) == JobState::queued);
        }
        CHECK(s.store.release(s.store.claim(long_lease)->lease, Release::lost) == JobState::queued);
        CHECK(s.store.claim(long_lease)->attempt == 2);
    }

    TEST_CASE("a job that is put off lets others go first") {
        TestStore s;
        REQUIRE(s.add(new_job("A")) == Admission::queued);
        REQUIRE(s.add(new_job("B")) == Admission::queued);
        CHECK(s.store.release(s.store.claim(long_lease)->lease, Release::later) ==
              JobState::queued);
        CHECK(s.store.claim(long_lease)->id == "B");
        CHECK_FALSE(s.store.claim(long_lease).has_value());  // A: in five seconds
        CHECK(s.store.find("", "A")->attempt == 0);
    }

    TEST_CASE("a job that is canceled while it runs ends as canceled, whatever it returns") {
        TestStore s;
        REQUIRE(s.add(new_job("A")) == Admission::queued);
        const auto claim = s.store.claim(long_lease).value();
        CHECK(s.store.cancel("", "A") == JobState::canceling);
        CHECK(s.store.cancel("", "A") == JobState::canceling);
        CHECK(s.store.renew(claim.lease, long_lease) == Hold::canceling);
        CHECK(s.store.finish(claim.lease, success()) == JobState::canceled);
        CHECK(s.store.find("", "A")->result.empty());
        CHECK(s.store.find("", "A")->reason == "client");
        CHECK(s.store.cancel("", "A") == JobState::canceled);
    }

    TEST_CASE("a deadline cancels what waits and what runs") {
        TestStore s;
        NewJob waits = new_job("B"), runs = new_job("A"), later = new_job("C");
        waits.cancel_at_ms = runs.cancel_at_ms = now_ms() - 1;
        later.cancel_at_ms = now_ms() + 60'000;
        for (const NewJob& job : {runs, waits, later}) REQUIRE(s.add(job) == Admission::queued);
        const auto claim = s.store.claim(long_lease).value();
        CHECK(s.store.sweep(false, test::lost).changed.size() == 2);
        CHECK(s.state("A") == JobState::canceling);
        CHECK(s.state("B") == JobState::canceled);
        CHECK(s.state("C") == JobState::queued);
        CHECK(s.store.release(claim.lease, Release::unfinished) == JobState::canceled);
        CHECK(s.store.find("", "A")->reason == "deadline");
    }

    TEST_CASE("full queues take nothing, of all and of one owner") {
        TestStore s;
        const QueueLimits limits{3, 2};
        CHECK(s.add(new_job("A", "key"), limits) == Admission::queued);
        CHECK(s.add(new_job("B", "key"), limits) == Admission::queued);
        CHECK(s.add(new_job("C", "key"), limits) == Admission::owner_queue_full);
        CHECK(s.add(new_job("D", "other"), limits) == Admission::queued);
        CHECK(s.add(new_job("E", "other"), limits) == Admission::queue_full);
        CHECK_FALSE(s.store.find("", "E").has_value());
        (void)s.store.claim(long_lease);
        CHECK(s.add(new_job("F", "other"), limits) == Admission::queued);
    }

    TEST_CASE("an owner keeps so many bytes, of models, results and assets, and not more") {
        TestStore s;
        SqliteAssets assets(s.database);
        QueueLimits limits;
        limits.bytes_of_owner = 100;
        const auto job_of = [](const char* id, std::uint64_t bytes) {
            NewJob job = new_job(id, "key");
            job.model_bytes = bytes;
            return job;
        };
        AssetLimits asset_limits;
        asset_limits.bytes_of_owner = 100;
        CHECK(s.add(job_of("A", 60), limits) == Admission::queued);
        CHECK(s.add(job_of("B", 41), limits) == Admission::storage_full);
        CHECK(assets.add("key", "digest", 41, asset_limits) == AssetAdmission::storage_full);
        CHECK(assets.add("key", "digest", 30, asset_limits) == AssetAdmission::added);
        CHECK(s.add(job_of("B", 11), limits) == Admission::storage_full);
        CHECK(s.add(new_job("B", "other"), limits) == Admission::queued);
        Succeeded result = success();  // of 4 bytes
        CHECK(s.store.finish(s.store.claim(long_lease)->lease, result));
        CHECK(s.add(job_of("C", 67), limits) == Admission::storage_full);  // 30 + 4 + 67
        CHECK(s.add(job_of("C", 66), limits) == Admission::queued);
        CHECK(s.store.remove("key", "C"));
        CHECK(assets.remove("key", "digest"));
        SqliteStore strict(s.database, Retention{-1, 3600'000});
        (void)strict.sweep(false, test::lost);
        CHECK(s.add(job_of("D", 100), limits) == Admission::queued);
        CHECK(s.store.cancel("key", "D"));
        CHECK(s.add(job_of("E", 100), limits) == Admission::queued);
    }

    TEST_CASE("the same key with the same job is a repetition, with another it is refused") {
        TestStore s;
        NewJob job = new_job("A");
        job.idempotency_key = "order-1";
        CHECK(s.add(job) == Admission::queued);
        NewJob again = job;
        again.id = "B";
        CHECK(s.store.add(again, {}).id == "A");
        CHECK(s.add(again) == Admission::repeated);
        again.fingerprint = "another";
        CHECK(s.add(again) == Admission::key_reused);
        again.owner = "somebody else";
        CHECK(s.add(again) == Admission::queued);
        CHECK(s.add(new_job("A")) == Admission::repeated);
        NewJob taken = new_job("A");
        taken.fingerprint = "another";
        CHECK(s.add(taken) == Admission::id_taken);
    }

    TEST_CASE("a batch is taken whole or not at all") {
        TestStore s;
        const auto batch_of = [](const char* id, int jobs, const char* key = "") {
            NewBatch batch{id, "key", std::string("print-") + std::to_string(jobs), key, {}};
            for (int i = 0; i < jobs; ++i) {
                batch.jobs.push_back(new_job(id + std::to_string(i), "key"));
                batch.jobs.back().batch = id;
            }
            return batch;
        };
        const QueueLimits limits{5, 4};
        CHECK(s.store.add(batch_of("B", 5), limits).admission == Admission::owner_queue_full);
        CHECK_FALSE(s.store.find("key", "B0").has_value());
        CHECK_FALSE(s.store.find_batch("key", "B").has_value());
        CHECK(s.store.add(batch_of("B", 3, "once"), limits).admission == Admission::queued);
        const Admitted again = s.store.add(batch_of("C", 3, "once"), limits);
        CHECK(again.admission == Admission::repeated);
        CHECK(again.id == "B");
        CHECK(s.store.add(batch_of("C", 2, "once"), limits).admission == Admission::key_reused);
        CHECK(s.store.add(batch_of("C", 2), limits).admission == Admission::owner_queue_full);
        CHECK(s.store.find_batch("key", "B")->states.at(JobState::queued) == 3);
        CHECK(s.store.find_batch("key", "B")->size == 3);
        CHECK_FALSE(s.store.find_batch("other", "B").has_value());
    }

    TEST_CASE("a batch has finished when the last of its jobs has ended or is deleted") {
        TestStore s;
        NewBatch batch{"B", "key", "print", "once", {}};
        for (const char* id : {"B0", "B1", "B2"}) {
            batch.jobs.push_back(new_job(id, "key"));
            batch.jobs.back().batch = "B";
        }
        REQUIRE(s.store.add(batch, {}).admission == Admission::queued);
        REQUIRE(s.store.finish(s.store.claim(long_lease)->lease, success()));
        CHECK(s.store.cancel("key", "B1"));
        CHECK_FALSE(s.store.find_batch("key", "B")->finished_ms.has_value());
        CHECK(s.store.remove("key", "B2"));
        const BatchRecord finished = s.store.find_batch("key", "B").value();
        CHECK(finished.finished_ms.has_value());
        CHECK(finished.states.size() == 2);
        CHECK(finished.size == 3);
        for (const char* id : {"B0", "B1"}) CHECK(s.store.remove("key", id));
        CHECK_FALSE(s.store.find_batch("key", "B").has_value());
        CHECK(s.store.add(batch, {}).admission == Admission::queued);  // its key is free again
    }

    TEST_CASE("owners see their own jobs only") {
        TestStore s;
        REQUIRE(s.add(new_job("A", "one")) == Admission::queued);
        CHECK_FALSE(s.store.find("two", "A").has_value());
        CHECK_FALSE(s.store.cancel("two", "A").has_value());
        CHECK_FALSE(s.store.remove("two", "A").has_value());
        CHECK(s.store.list("two", {}).jobs.empty());
        CHECK(s.store.find("one", "A").has_value());
        CHECK(s.store.remove("one", "A").has_value());
    }

    TEST_CASE("an id is an owner's own: others may have the same, and neither meets the other") {
        TestStore s;
        NewJob other = new_job("A", "two");
        other.fingerprint = "another";
        other.idempotency_key = "order-1";
        REQUIRE(s.add(new_job("A", "one")) == Admission::queued);
        REQUIRE(s.add(other) == Admission::queued);
        const auto first = s.store.claim(long_lease).value(),
                   second = s.store.claim(long_lease).value();
        CHECK(first.owner != second.owner);
        REQUIRE(s.store.finish(first.lease, success("of one")));
        CHECK(s.store.find("two", "A")->state == JobState::running);
        CHECK(s.store.remove("one", "A").has_value());
        CHECK(s.store.find("two", "A")->state == JobState::running);
        CHECK(s.add(other) == Admission::repeated);
        SqliteStore strict(s.database, Retention{-1, -1});
        REQUIRE(s.store.finish(second.lease, success()));
        (void)strict.sweep(false, test::lost);
        CHECK(strict.is_expired("two", "A"));
        CHECK_FALSE(strict.is_expired("one", "A"));
    }

    TEST_CASE("a list goes on where it stopped, with its filters") {
        TestStore s;
        for (int i = 0; i < 25; ++i) {
            NewJob job = new_job("J" + std::to_string(i));
            job.tag = i % 2 == 0 ? "even" : "odd";
            REQUIRE(s.add(job) == Admission::queued);
        }
        JobFilter filter;
        filter.limit = 5;
        filter.tag = "even";
        std::set<std::string> seen;
        int pages = 0;
        for (;; ++pages) {
            const JobList list = s.store.list("", filter);
            for (const JobRecord& job : list.jobs) {
                CHECK(job.tag == "even");
                CHECK(seen.insert(job.id).second);
            }
            if (!list.next) break;
            filter.before = list.next;
        }
        CHECK(seen.size() == 13);
        CHECK(pages == 2);
        filter = {};
        filter.state = JobState::running;
        CHECK(s.store.list("", filter).jobs.empty());
    }

    TEST_CASE("results and jobs are forgotten when their time is over, and the job remembered") {
        TestStore s(Retention{-1, 3600'000});
        REQUIRE(s.add(new_job("A")) == Admission::queued);
        CHECK(s.store.finish(s.store.claim(long_lease)->lease, success("blob")));
        CHECK(s.store.needs_blob("blob"));
        CHECK(s.store.sweep(false, test::lost).blobs == std::vector<std::string>{"blob"});
        CHECK_FALSE(s.store.needs_blob("blob"));
        CHECK(s.state("A") == JobState::succeeded);

        SqliteStore strict(s.database, Retention{-1, -1});
        (void)strict.sweep(false, test::lost);
        CHECK_FALSE(strict.find("", "A").has_value());
        CHECK(strict.is_expired("", "A"));
        CHECK_FALSE(strict.is_expired("somebody", "A"));
        CHECK_FALSE(strict.is_expired("", "B"));
    }

    TEST_CASE("a model is needed until its job has ended") {
        TestStore s;
        REQUIRE(s.add(new_job("A")) == Admission::queued);
        CHECK(s.store.needs_blob("model-A"));
        const auto claim = s.store.claim(long_lease).value();
        CHECK(s.store.needs_blob("model-A"));
        CHECK(s.store.finish(claim.lease, failure()) == JobState::failed);
        CHECK_FALSE(s.store.needs_blob("model-A"));
        CHECK(s.store.remove("", "A").has_value());
        CHECK_FALSE(s.store.remove("", "A").has_value());
    }

    TEST_CASE("of many workers exactly one gets each job") {
        TestStore s;
        constexpr int jobs = 60;
        std::atomic<int> finished{0};
        std::vector<std::thread> workers;
        for (int w = 0; w < 4; ++w) {
            workers.emplace_back([&] {
                (void)eventually([&] {
                    while (const auto claim = s.store.claim(long_lease)) {
                        if (s.store.finish(claim->lease, failure())) ++finished;
                    }
                    return finished >= jobs;
                });
            });
        }
        for (int i = 0; i < jobs; ++i) {
            CHECK(s.add(new_job("J" + std::to_string(i))) == Admission::queued);
        }
        for (std::thread& worker : workers) worker.join();
        CHECK(finished == jobs);
        for (int i = 0; i < jobs; ++i)
            CHECK(s.store.find("", "J" + std::to_string(i))->attempt == 1);
    }
}

}  // namespace lastflat::server
