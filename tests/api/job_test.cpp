#include "api/job.h"

#include <doctest/doctest.h>

#include "api/batch.h"
#include "api/job_event.h"
#include "api/object_reader.h"
#include "api/timestamp.h"
#include "tests/api/contract_document.h"

namespace lastflat::api {
namespace {

Job job(const std::string& id, JobState state) {
    Job job;
    job.id = id;
    job.state = state;
    job.created_ms = 1'772'352'000'000;
    return job;
}

nlohmann::json read(const std::string& text) {
    return nlohmann::json::parse(text);
}

}  // namespace

TEST_SUITE("api/job") {
    TEST_CASE("the states are those of the contract") {
        CHECK(test::words(job_states) ==
              test::schema("JobState").at("enum").get<std::set<std::string>>());
        CHECK(value_of(job_states, "canceling") == JobState::canceling);
        CHECK_FALSE(value_of(job_states, "cancelled").has_value());
    }

    TEST_CASE("a queued job says where it stands, a running one how far it is") {
        Job queued = job("A", JobState::queued);
        queued.tag = "order";
        queued.queue_position = 2;
        queued.queue_s = 0.26;
        CHECK(to_json(queued) ==
              R"({"id":"A","state":"queued","tag":"order","priority":"interactive",)"
              R"("created_at":"2026-03-01T08:00:00.000Z",)"
              R"("attempt":0,"progress":{"stage":"queued","percent":0},)"
              R"("queue":{"position":2,"eta_s":0.3},"links":{"self":"/v1/jobs/A",)"
              R"("result":"/v1/jobs/A/result","metrics":"/v1/jobs/A/metrics",)"
              R"("events":"/v1/jobs/A/events","cancel":"/v1/jobs/A/cancel"}})");
        Job running = job("A", JobState::running);
        running.stage = "cut";
        running.percent = 20;
        running.remaining_s = 1.04;
        CHECK(read(to_json(running))["progress"].dump() ==
              R"({"percent":20,"remaining_s":1.0,"stage":"cut"})");
    }

    TEST_CASE("a failed job has its problem, a finished one its result") {
        Job failed = job("A", JobState::failed);
        failed.error = Problem("curve_invalid", "no such curve");
        CHECK(read(to_json(failed))["error"]["code"] == "curve_invalid");
        const auto finished = read(to_json(job("A", JobState::succeeded), R"({"regions":[]})"));
        CHECK(finished["state"] == "succeeded");
        CHECK(finished["result"].dump() == R"({"regions":[]})");
    }

    TEST_CASE("a list names the place where it goes on, if it does") {
        CHECK(to_json(JobList{{}, ""}) == R"({"items":[]})");
        const auto list = read(to_json(JobList{{job("A", JobState::queued)}, "next"}));
        CHECK(list["items"][0]["id"] == "A");
        CHECK(list["next_cursor"] == "next");
    }
}

TEST_SUITE("api/batch") {
    TEST_CASE("each job is read for itself") {
        const BatchRequest batch(
            R"({"jobs": [{"model": {"asset_id": "a"}, "request": {"tag": "t"}}, {"model": {}}]})");
        REQUIRE(batch.size() == 2);
        CHECK(batch.job(0).asset_id == "a");
        CHECK(batch.job(0).request.tag == "t");
        try {
            (void)batch.job(1);
            FAIL("was read");
        } catch (const InvalidRequest& error) {
            CHECK(error.pointer() == "/model");
        }
        CHECK_THROWS_AS(BatchRequest("{}"), InvalidRequest);
        CHECK_THROWS_AS(BatchRequest(R"({"jobs": {}})"), InvalidRequest);
    }

    TEST_CASE("what was taken and what was refused is counted") {
        const Batch batch{
            "B", {{202, job("A", JobState::queued)}, {422, Problem("model_missing", "none")}}};
        const auto answer = read(to_json(batch));
        CHECK(answer["taken"] == 1);
        CHECK(answer["refused"] == 1);
        CHECK(answer["items"][0]["job"]["id"] == "A");
        CHECK(answer["items"][1]["problem"]["code"] == "model_missing");
        CHECK(answer["items"][1]["status"] == 422);
        CHECK(answer["links"]["self"] == "/v1/batches/B");
    }

    TEST_CASE("a batch has ended when all of its jobs have") {
        BatchState batch{"B", {job("A", JobState::failed), job("C", JobState::running)}};
        auto answer = read(to_json(batch));
        CHECK(answer["finished"] == false);
        CHECK(answer["states"].dump() == R"({"failed":1,"running":1})");
        batch.items[1].state = JobState::failed;
        answer = read(to_json(batch));
        CHECK(answer["finished"] == true);
        CHECK(answer["states"].dump() == R"({"failed":2})");
    }
}

TEST_SUITE("api/job_event") {
    TEST_CASE("events say what happened") {
        CHECK(to_json(StateEvent{JobState::running, 1'772'352'000'000, 1}) ==
              R"({"state":"running","at":"2026-03-01T08:00:00.000Z","attempt":1})");
        CHECK(to_json(ProgressEvent{"cut", 20}) == R"({"stage":"cut","percent":20})");
    }

    TEST_CASE("repairs and warnings of a result are logged, or why there is none") {
        CHECK(log_events(R"({"repairs": [{"code": "a", "count": 2}], "warnings": []})") ==
              std::vector<std::string>{R"({"level":"info","code":"a","count":2})"});
        CHECK(log_events(R"({"repairs": [], "warnings": [{"code": "b"}]})") ==
              std::vector<std::string>{R"({"level":"warning","code":"b"})"});
        CHECK(log_event({"result_corrupt", "changed"}) ==
              R"({"level":"error","code":"result_corrupt","detail":"changed"})");
    }
}

TEST_SUITE("api/timestamp") {
    TEST_CASE("times are RFC 3339 in UTC, also on leap days") {
        for (const std::int64_t ms : {std::int64_t{0}, std::int64_t{1'709'251'199'123}}) {
            CHECK(rfc3339_ms(rfc3339(ms)) == ms);
        }
        CHECK(rfc3339(0) == "1970-01-01T00:00:00.000Z");
        CHECK(rfc3339(1'709'251'199'123) == "2024-02-29T23:59:59.123Z");
        CHECK_FALSE(rfc3339_ms("yesterday").has_value());
    }
}

}  // namespace lastflat::api
