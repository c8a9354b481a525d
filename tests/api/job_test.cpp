#include "api/job.h"

#include <doctest/doctest.h>

#include "api/batch.h"
#include "api/batch_table.h"
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
    TEST_CASE("each job is read for itself, and a fault names the job") {
        const BatchRequest batch(
            R"({"jobs": [{"model": {"asset_id": "a"}, "request": {"tag": "t"}, "priority": "batch"},
                         {"model": {}}, {"model": {"asset_id": "a"}, "request": {"lock": 1}}]})");
        REQUIRE(batch.size() == 3);
        CHECK(batch.job(0).asset_id == "a");
        CHECK(batch.job(0).request.tag == "t");
        CHECK(batch.job(0).priority == JobPriority::batch);
        const auto pointer_of = [&](std::size_t index) {
            try {
                (void)batch.job(index);
            } catch (const InvalidRequest& error) {
                return error.pointer();
            }
            return std::string("was read");
        };
        CHECK(pointer_of(1) == "/jobs/1/model");
        CHECK(pointer_of(2) == "/jobs/2/request/lock");
        for (const char* broken : {"{}", R"({"jobs": {}})", R"({"jobs": []})"})
            CHECK_THROWS_AS(BatchRequest{broken}, InvalidRequest);
    }

    TEST_CASE("a batch says how many of its jobs are in which state") {
        Batch batch{"B", 0, {}, 3, {{JobState::failed, 1}, {JobState::running, 1}}, {}};
        batch.items.push_back(job("A", JobState::failed));
        auto answer = read(to_json(batch));
        CHECK(answer["finished"] == false);
        CHECK(answer["size"] == 3);
        CHECK(answer["states"]["failed"] == 1);
        CHECK(answer["states"]["running"] == 1);
        CHECK(answer["items"][0]["id"] == "A");
        CHECK(answer["links"]["archive"] == "/v1/batches/B/result.zip");
        batch.finished_ms = 1'772'352'000'000;
        answer = read(to_json(batch));
        CHECK(answer["finished"] == true);
        CHECK(answer["finished_at"] == "2026-03-01T08:00:00.000Z");
    }

    TEST_CASE("a table has a row for every curve and piece, and no text that is run as a formula") {
        BatchTable table;
        Job good = job("A", JobState::succeeded);
        good.tag = "=cmd, \"x\"";
        table.add(good, R"({"regions": [{"name": "lateral", "curves": [
            {"name": "-heel", "locked": true, "length_3d_mm": 80, "length_2d_mm": 80,
             "worst_edge_error_mm": 1e-9, "verdict": "pass"},
            {"name": "toe", "locked": false, "length_3d_mm": 100, "length_2d_mm": 99,
             "worst_edge_error_mm": 0.5}]}]})");
        Job bad = job("C", JobState::failed);
        bad.error = Problem("unreadable_model", "it is broken");
        table.add(bad, "");
        const std::string text = table.text();
        CHECK(text.substr(text.find("\r\n") + 2) ==
              "A,\"'=cmd, \"\"x\"\"\",succeeded,,lateral,'-heel,yes,80.000000,80.000000,0.000000,"
              "0.000000,0.000000,pass\r\n"
              "A,\"'=cmd, \"\"x\"\"\",succeeded,,lateral,toe,no,100.000000,99.000000,-1.000000,"
              "-1.000000,0.500000,\r\n"
              "C,,failed,unreadable_model,,,,,,,,,\r\n");
    }

    TEST_CASE("jobs without a result are listed with the reason") {
        BatchErrors errors;
        errors.add(job("A", JobState::failed), Problem("unreadable_model", "it is broken"));
        const auto list = read(errors.json());
        CHECK(list["items"][0]["job"] == "A");
        CHECK(list["items"][0]["problem"]["code"] == "unreadable_model");
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
