#include "server/runner/runner_pool.h"

#include <doctest/doctest.h>

#include <atomic>
#include <fstream>
#include <latch>
#include <set>

#include "server/jobs/estimate.h"
#include "server/jobs/job_control.h"
#include "server/storage/blob_folder.h"
#include "server/support/clock.h"
#include "server/support/crypto.h"
#include "tests/helpers/eventually.h"
#include "tests/server/storage/test_store.h"

namespace lastflat::server {
namespace {

using lastflat::test::eventually;
using test::new_job;

struct PoolSetting : test::TestStore {
    BlobFolder blobs{folder.path() / "blobs"};
    JobWatch watch;
    std::mutex mutex;
    std::vector<RunReport> reports;

    PoolOptions options(std::size_t workers, std::int64_t lease_ms = 60'000) const {
        return {workers, lease_ms, folder.path()};
    }
    RunLog log() {
        return [this](const RunReport& report) {
            const std::scoped_lock lock(mutex);
            reports.push_back(report);
        };
    }
    std::string outcome(std::size_t run) {
        const std::scoped_lock lock(mutex);
        return run < reports.size() ? reports[run].outcome : "";
    }
    /// The job in its final state, which the pool announces.
    JobRecord ended(const std::string& id) {
        JobWatch::Subscription subscription(watch, store.find("", id).value().number);
        const auto deadline = JobWatch::Clock::now() + lastflat::test::long_enough;
        for (;;) {
            JobRecord job = store.find("", id).value();
            if (is_final(job.state)) return job;
            REQUIRE(subscription.wait_until(deadline));
        }
    }
    [[nodiscard]] bool runs(const std::string& id) {
        return eventually([&] { return state(id) == JobState::running; });
    }
    [[nodiscard]] bool reported(std::size_t run) {
        return eventually([&] { return !outcome(run).empty(); });
    }
};

ProcessEnd finished(const std::filesystem::path& file) {
    write_durably(file, "a result");
    return Succeeded{sha256("a result"), {}};
}

ProcessEnd ended_as(Unfinished::Kind kind) {
    return Unfinished{kind, {}};
}

ProcessEnd until_stopped(const ProcessControl& control) {
    const bool stopped = eventually(control.must_stop);
    return ended_as(stopped ? Unfinished::Kind::stopped : Unfinished::Kind::crashed);
}

}  // namespace

TEST_SUITE("server/runner/runner_pool") {
    TEST_CASE("every job that is added is run once, and its result kept") {
        PoolSetting s;
        std::atomic<int> runs{0};
        RunnerPool pool(
            s.store, s.blobs, s.watch, s.options(4),
            [&](const Claim&, const std::filesystem::path& file, const ProcessControl&) {
                ++runs;
                return finished(file);
            },
            s.log());
        for (int i = 0; i < 50; ++i) {
            REQUIRE(s.add(new_job("J" + std::to_string(i))) == Admission::queued);
            pool.wake();
        }
        for (int i = 0; i < 50; ++i) {
            const JobRecord job = s.ended("J" + std::to_string(i));
            CHECK(job.state == JobState::succeeded);
            CHECK(s.blobs.read(job.result) == "a result");
        }
        CHECK(runs == 50);
    }

    TEST_CASE("a running job is stopped when it is canceled or removed") {
        PoolSetting s;
        RunnerPool pool(
            s.store, s.blobs, s.watch, s.options(1),
            [](const Claim&, const std::filesystem::path&, const ProcessControl& control) {
                return until_stopped(control);
            },
            s.log());
        for (const bool removes : {false, true}) {
            REQUIRE(s.add(new_job("A")) == Admission::queued);
            pool.wake();
            REQUIRE(s.runs("A"));
            const JobNumber number = s.store.find("", "A").value().number;
            if (removes) {
                CHECK(s.store.remove("", "A").has_value());
                pool.cancel(number);
                REQUIRE(s.reported(1));
                CHECK(s.outcome(1) == "lost");
            } else {
                CHECK(s.store.cancel("", "A") == JobState::canceling);
                pool.cancel(number);
                CHECK(s.ended("A").state == JobState::canceled);
                CHECK(s.store.remove("", "A").has_value());
            }
        }
    }

    TEST_CASE("what a process does decides what becomes of its job") {
        using Kind = Unfinished::Kind;
        for (const auto& [kind, code, runs] : {std::tuple(Kind::crashed, "worker_crashed", 1),
                                               std::tuple(Kind::lost, "worker_lost", 3),
                                               std::tuple(Kind::timed_out, "job_too_slow", 1)}) {
            PoolSetting s;
            RunnerPool pool(
                s.store, s.blobs, s.watch, s.options(1),
                [kind = kind](const Claim&, const std::filesystem::path&, const ProcessControl&) {
                    return ended_as(kind);
                },
                s.log());
            REQUIRE(s.add(new_job("A")) == Admission::queued);
            pool.wake();
            const JobRecord job = s.ended("A");
            CHECK(job.state == JobState::failed);
            CHECK(job.error.value().code.word() == code);
            CHECK(job.attempt == runs);
        }
    }

    TEST_CASE("at the end running jobs go back to the queue, and nothing new is begun") {
        PoolSetting s;
        RunnerPool pool(
            s.store, s.blobs, s.watch, s.options(1),
            [](const Claim&, const std::filesystem::path&, const ProcessControl& control) {
                return until_stopped(control);
            },
            s.log());
        REQUIRE(s.add(new_job("A")) == Admission::queued);
        REQUIRE(s.add(new_job("B")) == Admission::queued);
        pool.wake();
        REQUIRE(s.runs("A"));
        pool.stop(std::chrono::milliseconds(10));
        for (const char* id : {"A", "B"}) {
            CHECK(s.state(id) == JobState::queued);
            CHECK(s.store.find("", id)->attempt == 0);
        }
    }

    TEST_CASE("a lease is renewed while the job runs, and a lost one ends the run") {
        PoolSetting s;
        constexpr std::int64_t lease_ms = 200;
        std::atomic<bool> go_on{true};
        RunnerPool pool(
            s.store, s.blobs, s.watch, s.options(1, lease_ms),
            [&](const Claim&, const std::filesystem::path& file, const ProcessControl& control) {
                bool stops = false;
                (void)eventually([&] { return (stops = control.must_stop()) || !go_on; });
                return stops ? ended_as(Unfinished::Kind::stopped) : finished(file);
            },
            s.log());
        REQUIRE(s.add(new_job("A")) == Admission::queued);
        pool.wake();
        REQUIRE(s.runs("A"));
        const std::int64_t first_end = now_ms() + lease_ms;
        REQUIRE(eventually([&] { return now_ms() > first_end; }));
        CHECK(s.store.sweep(false, test::lost).changed.empty());
        CHECK(s.store.sweep(true, test::lost).changed.size() == 1);  // as if it had been silent
        REQUIRE(s.reported(0));
        CHECK(s.outcome(0) == "lost");
        go_on = false;
        CHECK(s.ended("A").attempt == 2);
    }
}

TEST_SUITE("server/jobs/job_watch") {
    TEST_CASE("a subscription notices every change from its beginning on, and the end of all") {
        using Clock = JobWatch::Clock;
        JobWatch watch;
        JobWatch::Subscription subscription(watch, 1);
        CHECK_FALSE(subscription.wait_until(Clock::now()));
        watch.changed(1);
        CHECK(subscription.wait_until(Clock::now()));
        CHECK_FALSE(subscription.wait_until(Clock::now()));
        watch.changed(2);
        CHECK_FALSE(subscription.wait_until(Clock::now()));
        watch.reach(1, "cut", 0.25);
        CHECK(subscription.wait_until(Clock::now()));
        CHECK(watch.progress(1)->stage == "cut");
        watch.reach(1, "measure", 0.5);
        CHECK(watch.progress(1)->number == 2);
        watch.ended(1);
        CHECK_FALSE(watch.progress(1).has_value());
        CHECK(subscription.wait_until(Clock::now()));
        std::thread closer([&] { watch.close(std::chrono::milliseconds(0)); });
        CHECK_FALSE(subscription.wait_until(Clock::now() + std::chrono::hours(1)));
        closer.join();
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

    TEST_CASE("an estimate needs three jobs like it") {
        Estimate estimate;
        estimate.note(100, 1.0);
        estimate.note(110, 3.0);
        estimate.note(90'000, 50.0);
        CHECK_FALSE(estimate.seconds(100).has_value());
        estimate.note(120, 2.0);
        CHECK(estimate.seconds(100).value() == 2.0);
        CHECK_FALSE(estimate.seconds(90'000).has_value());
        CHECK(estimate.seconds().has_value());
    }
}

}  // namespace lastflat::server
