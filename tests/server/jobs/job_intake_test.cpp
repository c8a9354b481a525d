#include "server/jobs/job_intake.h"

#include <doctest/doctest.h>

#include "api/object_reader.h"
#include "server/storage/sqlite_accounts.h"
#include "server/support/clock.h"
#include "server/support/crypto.h"
#include "tests/server/jobs/memory_blobs.h"
#include "tests/server/storage/test_store.h"

namespace lastflat::server {
namespace {

struct WakesCounted final : JobExecutor {
    int wakes = 0;
    void wake() override { ++wakes; }
    void cancel(JobNumber) override {}
};

struct IntakeSetting : test::TestStore {
    SqliteAssets assets{database};
    test::MemoryBlobs blobs;
    WakesCounted executor;
    std::atomic<bool> draining{false};
    IntakeLimits limits;
    JobIntake intake;

    explicit IntakeSetting(const IntakeLimits& given = {{}, 0, false})
        : limits(given), intake(store, assets, blobs, executor, limits, draining) {}

    std::string code_of(const Submission& submission) {
        try {
            (void)intake.submit(submission);
        } catch (const api::Refusal& refusal) {
            return std::string(refusal.problem().code.word());
        }
        return "taken";
    }
};

Submission submission_of(std::string_view model, const std::string& key = "") {
    Submission submission;
    submission.model = model;
    submission.request = "{}";
    submission.idempotency_key = key;
    return submission;
}

}  // namespace

TEST_SUITE("server/jobs/job_intake") {
    TEST_CASE("what is taken is a queued job whose model is kept, and somebody is woken for it") {
        IntakeSetting s;
        Submission submission = submission_of("v 0 0 0");
        submission.owner = "key";
        submission.tag = "order-7";
        submission.cancel_after = "1h";
        constexpr std::int64_t hour_ms = 3'600'000;
        const std::int64_t begun_ms = now_ms();
        const Submitted taken = s.intake.submit(submission);
        CHECK_FALSE(taken.repeated);
        CHECK(taken.job.id.size() == 26);
        CHECK(taken.job.state == JobState::queued);
        CHECK(taken.job.tag == "order-7");
        CHECK(taken.job.model_bytes == 7);
        CHECK(taken.job.cancel_at_ms.value() >= begun_ms + hour_ms);
        CHECK(taken.job.cancel_at_ms.value() <= now_ms() + hour_ms);
        CHECK(s.blobs.read(sha256("v 0 0 0")) == "v 0 0 0");
        CHECK(s.executor.wakes == 1);
        CHECK(s.store.find("key", taken.job.id).has_value());
        CHECK_FALSE(s.store.find("another", taken.job.id).has_value());
    }

    TEST_CASE("the same key and the same request are one job, another request is refused") {
        IntakeSetting s;
        const std::string id = s.intake.submit(submission_of("a", "once")).job.id;
        const Submitted again = s.intake.submit(submission_of("a", "once"));
        CHECK(again.repeated);
        CHECK(again.job.id == id);
        CHECK(s.executor.wakes == 1);
        CHECK(s.code_of(submission_of("b", "once")) == "key_reused");
        Submission sooner = submission_of("a", "once");
        sooner.cancel_after = "1h";
        CHECK(s.code_of(sooner) == "key_reused");
        Submission other_owner = submission_of("b", "once");
        other_owner.owner = "key";
        CHECK(s.code_of(other_owner) == "taken");
        CHECK_FALSE(s.intake.submit(submission_of("a")).repeated);
    }

    TEST_CASE("an id of the client's own is kept, and belongs to one request") {
        IntakeSetting s;
        Submission submission = submission_of("a");
        submission.id = "0123456789ABCDEFGHJKMNPQRS";
        CHECK(s.intake.submit(submission).job.id == submission.id);
        CHECK(s.intake.submit(submission).repeated);
        submission.request = R"({"units": "mm"})";
        CHECK(s.code_of(submission) == "id_taken");
    }

    TEST_CASE("what is not taken leaves no model behind") {
        IntakeSetting s({{1, 1}, 0, false});
        CHECK(s.code_of(submission_of("a")) == "taken");
        CHECK(s.code_of(submission_of("b")) == "queue_full");
        CHECK(s.blobs.all() == std::vector<std::string>{sha256("a")});
        CHECK(s.code_of(submission_of("a")) == "queue_full");
        CHECK(s.blobs.all() == std::vector<std::string>{sha256("a")});  // the first one needs it
    }

    TEST_CASE("a batch is kept whole or leaves nothing behind") {
        IntakeSetting s({{10, 3}, 0, false});
        std::vector<std::string> models{"a", "b", "c"};
        BatchSubmission batch{"key", "once", 3, [&](std::size_t index) {
                                  if (models[index] == "broken")
                                      throw api::InvalidRequest("/jobs/" + std::to_string(index),
                                                                "is broken");
                                  return submission_of(models[index]);
                              }};
        const auto code_of_batch = [&] {
            try {
                return s.intake.submit(batch).repeated ? std::string("repeated") : "taken";
            } catch (const api::Refusal& refusal) {
                return std::string(refusal.problem().code.word());
            }
        };
        models[2] = "broken";
        CHECK(code_of_batch() == "invalid_request");
        CHECK(s.blobs.all().empty());
        models[2] = "c";
        CHECK(code_of_batch() == "taken");
        CHECK(s.blobs.all().size() == 3);
        CHECK(s.executor.wakes == 1);
        CHECK(code_of_batch() == "repeated");
        models[0] = "d";
        CHECK(code_of_batch() == "key_reused");
        batch.idempotency_key.clear();
        CHECK(code_of_batch() == "key_queue_full");
        CHECK(s.blobs.all().size() == 3);
        batch.size = 4;
        CHECK(code_of_batch() == "invalid_request");  // it could never be taken
        const JobList jobs = s.store.list("key", {});
        CHECK(jobs.jobs.size() == 3);
        CHECK(jobs.jobs[0].priority == api::JobPriority::batch);
    }

    TEST_CASE("one key's jobs do not fill the queue of others") {
        IntakeSetting s({{10, 1}, 0, false});
        for (const char* owner : {"one", "another"}) {
            Submission submission = submission_of("a");
            submission.owner = owner;
            CHECK(s.code_of(submission) == "taken");
            CHECK(s.code_of(submission) == "key_queue_full");
        }
    }

    TEST_CASE("an asset of one's own stands in for a model") {
        IntakeSetting s;
        const std::string digest = s.blobs.put("v 1 1 1");
        REQUIRE(s.assets.add("key", digest, 7, {}) == AssetAdmission::added);
        Submission submission = submission_of("");
        submission.asset = digest;
        CHECK(s.code_of(submission) == "asset_not_found");
        submission.owner = "key";
        CHECK(s.intake.submit(submission).job.model == digest);
        submission.asset = sha256("something else");
        CHECK(s.code_of(submission) == "asset_not_found");
    }

    TEST_CASE("a service that ends, has no room or sends no webhooks says so and keeps nothing") {
        IntakeSetting ends;
        ends.draining = true;
        CHECK(ends.code_of(submission_of("a")) == "draining");
        IntakeSetting full({{}, std::size_t(1) << 40, false});
        CHECK(full.code_of(submission_of("a")) == "storage_full");
        IntakeSetting quiet;
        Submission hooked = submission_of("a");
        hooked.webhook =
            api::WebhookRequest{"https://example.com/", {api::WebhookEvent::job_failed}, "whsec_"};
        CHECK(quiet.code_of(hooked) == "webhooks_off");
        for (IntakeSetting* s : {&ends, &full, &quiet}) {
            CHECK(s->blobs.all().empty());
            CHECK(s->executor.wakes == 0);
        }
        IntakeSetting sends({{}, 0, true});
        CHECK(sends.code_of(hooked) == "taken");
    }
}

}  // namespace lastflat::server
