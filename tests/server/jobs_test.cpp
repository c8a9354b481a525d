#include <doctest/doctest.h>

#include <latch>
#include <set>

#include "server/jobs/worker_pool.h"
#include "server/run_job.h"
#include "server/stores/memory_store.h"

namespace lastflat::server {
namespace {

JobInput input(const std::string& model = "model") {
    return {std::make_shared<const std::string>(model), {}, "tag"};
}

std::shared_ptr<const JobOutput> output(std::size_t bytes = 4) {
    const auto text = std::make_shared<const std::string>(bytes / 4, 'x');
    return std::make_shared<const JobOutput>(JobOutput{text, text, text, text});
}

/// Waits until a job is in a final state; a test that waits for ever is ended by its time limit.
JobRecord finished(const JobStore& store, const std::string& id) {
    for (;;) {
        const auto job = store.find(id);
        REQUIRE(job.has_value());
        if (is_final(job->state)) return *job;
        std::this_thread::yield();
    }
}

}  // namespace

TEST_SUITE("server/jobs/job_state") {
    TEST_CASE("a finished job never changes again") {
        for (const JobState from : {JobState::succeeded, JobState::failed, JobState::canceled}) {
            for (int to = 0; to < 6; ++to) CHECK_FALSE(may_become(from, static_cast<JobState>(to)));
        }
        CHECK_FALSE(may_become(JobState::queued, JobState::succeeded));
        CHECK_FALSE(may_become(JobState::canceling, JobState::succeeded));
    }
}

TEST_SUITE("server/jobs/job") {
    TEST_CASE("ids have 26 characters, sort by time and do not repeat") {
        std::set<std::string> ids;
        for (int i = 0; i < 1000; ++i) ids.insert(new_job_id());
        CHECK(ids.size() == 1000);
        CHECK(ids.begin()->size() == 26);
        CHECK(ids.begin()->find_first_not_of("0123456789ABCDEFGHJKMNPQRSTVWXYZ") ==
              std::string::npos);
    }
}

TEST_SUITE("server/stores/memory_store") {
    TEST_CASE("jobs are claimed oldest first, and their places are told") {
        MemoryStore store({});
        REQUIRE(store.add("A", input()));
        REQUIRE(store.add("B", input()));
        CHECK(store.find("B")->queue_position == 2);
        CHECK(store.claim()->id == "A");
        CHECK(store.find("A")->state == JobState::running);
        CHECK(store.find("B")->queue_position == 1);
        CHECK(store.claim()->id == "B");
        CHECK_FALSE(store.claim().has_value());
        CHECK(store.counts().running == 2);
    }

    TEST_CASE("a full queue keeps nothing of a new job") {
        MemoryLimits limits;
        limits.queued_jobs = 1;
        MemoryStore store(limits);
        CHECK(store.add("A", input()));
        CHECK_FALSE(store.add("B", input()));
        CHECK_FALSE(store.find("B").has_value());
        (void)store.claim();
        CHECK(store.add("C", input()));
    }

    TEST_CASE("models that wait are bounded by their bytes too, and give them back") {
        MemoryLimits limits;
        limits.queued_bytes = 10;
        MemoryStore store(limits);
        CHECK(store.add("A", input("12345678")));
        CHECK_FALSE(store.add("B", input("123")));
        CHECK(store.cancel("A") == JobState::canceled);
        CHECK(store.add("C", input("1234567890")));
        CHECK(store.remove("C"));
        CHECK(store.add("D", input("1234567890")));
        (void)store.claim();
        store.finish("D", {output(), {}});
        CHECK(store.add("E", input("1234567890")));
    }

    TEST_CASE("a job that is cancelled while it runs ends as canceled, whatever it returns") {
        MemoryStore store({});
        REQUIRE(store.add("A", input()));
        (void)store.claim();
        CHECK(store.cancel("A") == JobState::canceling);
        CHECK(store.cancel("A") == JobState::canceling);
        store.finish("A", {output(), {}});
        CHECK(store.find("A")->state == JobState::canceled);
        CHECK_FALSE(store.find("A")->output);
        CHECK(store.cancel("A") == JobState::canceled);
    }

    TEST_CASE("a job that is removed while it runs leaves nothing behind") {
        MemoryStore store({});
        REQUIRE(store.add("A", input()));
        (void)store.claim();
        CHECK(store.remove("A"));
        store.finish("A", {output(), {}});
        CHECK_FALSE(store.find("A").has_value());
        CHECK(store.counts().running == 0);
        CHECK_FALSE(store.remove("A"));
        CHECK_FALSE(store.cancel("A").has_value());
    }

    TEST_CASE("the oldest results make room for the newest") {
        MemoryLimits limits;
        limits.result_bytes = 100;
        limits.finished_jobs = 3;
        MemoryStore store(limits);
        for (const char* id : {"A", "B", "C", "D"}) {
            REQUIRE(store.add(id, input()));
            (void)store.claim();
            store.finish(id, {output(40), {}});
        }
        CHECK_FALSE(store.find("A").has_value());  // forgotten: more than three finished
        CHECK_FALSE(store.find("B")->output);      // expired: more than 100 bytes
        CHECK(store.find("B")->state == JobState::succeeded);
        CHECK(store.find("D")->output);
    }
}

TEST_SUITE("server/jobs/worker_pool") {
    TEST_CASE("every job that is added is run once") {
        MemoryStore store({});
        std::atomic<int> runs{0};
        WorkerPool pool(
            store,
            [&](const JobInput&, Progress&) {
                ++runs;
                return JobOutcome{output(), {}};
            },
            4);
        for (int i = 0; i < 200; ++i) {
            REQUIRE(store.add("J" + std::to_string(i), input()));
            pool.wake();
        }
        for (int i = 0; i < 200; ++i)
            CHECK(finished(store, "J" + std::to_string(i)).state == JobState::succeeded);
        CHECK(runs == 200);
    }

    TEST_CASE("a running job is cancelled through its progress") {
        MemoryStore store({});
        std::latch started(1);
        WorkerPool pool(
            store,
            [&](const JobInput&, Progress& progress) -> JobOutcome {
                started.count_down();
                try {
                    for (;;) progress.check();
                } catch (const Error&) {
                    return {};
                }
            },
            1);
        REQUIRE(store.add("A", input()));
        pool.wake();
        started.wait();
        CHECK(store.cancel("A") == JobState::canceling);
        pool.cancel("A");
        CHECK(finished(store, "A").state == JobState::canceled);
    }

    TEST_CASE("stopping lets a job finish within its grace and cancels it after") {
        for (const bool patient : {true, false}) {
            MemoryStore store({});
            std::latch started(1);
            std::atomic<bool> release{false};
            WorkerPool pool(
                store,
                [&](const JobInput&, Progress& progress) -> JobOutcome {
                    started.count_down();
                    try {
                        while (!release) progress.check();
                    } catch (const Error&) {
                        return {};
                    }
                    return {output(), {}};
                },
                1);
            REQUIRE(store.add("A", input()));
            REQUIRE(store.add("B", input()));
            pool.wake();
            started.wait();
            release = patient;
            CHECK(pool.stop(std::chrono::milliseconds(patient ? 60'000 : 0),
                            std::chrono::milliseconds(60'000)));
            CHECK(finished(store, "A").state ==
                  (patient ? JobState::succeeded : JobState::canceled));
            CHECK(store.find("B")->state == JobState::queued);
        }
    }
}

TEST_SUITE("server/run_job") {
    TEST_CASE("an error of core becomes a problem with its status") {
        Progress progress;
        const JobOutcome outcome = run_job(input("v 0 0 x"), progress);
        REQUIRE(outcome.error.has_value());
        CHECK(outcome.error->status == 422);
        CHECK(outcome.error->code == "unreadable_model");
        CHECK_FALSE(outcome.output);
    }
}

}  // namespace lastflat::server
