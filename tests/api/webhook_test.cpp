#include "api/webhook.h"

#include <doctest/doctest.h>

#include "api/object_reader.h"
#include "api/submission.h"
#include "tests/api/contract_document.h"

namespace lastflat::api {

TEST_SUITE("api/webhook") {
    TEST_CASE("the events are those of the contract, all of them if none is named") {
        const auto& events = test::schema("NewWebhook").at("properties").at("events");
        CHECK(test::words(webhook_events) ==
              events.at("items").at("enum").get<std::set<std::string>>());
        CHECK(webhook_from_json(R"({"url": "u"})").events.size() == 4);
        const auto asked = webhook_from_json(R"({"url": "u", "events": ["job.failed"]})");
        CHECK(asked.events == std::vector<WebhookEvent>{WebhookEvent::job_failed});
        CHECK_THROWS_AS((void)webhook_from_json(R"({"url": "u", "events": ["job.queued"]})"),
                        InvalidRequest);
    }

    TEST_CASE("a job's own webhook needs an address and a secret that is one") {
        const auto with = [](const std::string& webhook) {
            return json_submission_from_json(R"({"model": {"data": ""}, "webhook": )" + webhook +
                                             "}");
        };
        const std::string secret = "whsec_" + std::string(32, 'A');
        const auto webhook =
            with(R"({"url": "http://x/", "secret": ")" + secret + R"(", "events": ["job.failed"]})")
                .webhook.value();
        CHECK(webhook.url == "http://x/");
        CHECK(webhook.secret == secret);
        CHECK(webhook.events == std::vector<WebhookEvent>{WebhookEvent::job_failed});
        const auto pointer_of = [&](const std::string& text) {
            try {
                (void)with(text);
            } catch (const InvalidRequest& error) {
                return error.pointer();
            }
            return std::string("no error");
        };
        CHECK(pointer_of("{}") == "/webhook/secret");
        CHECK(pointer_of(R"({"secret": ")" + secret + "\"}") == "/webhook/url");
        for (const std::string& bad :
             {std::string("whsec_"), "secret" + secret.substr(6), "whsec_" + std::string(30, 'A'),
              "whsec_" + std::string(90, 'A'), "whsec_@" + secret})
            CHECK(pointer_of(R"({"url": "http://x/", "secret": ")" + bad + "\"}") ==
                  "/webhook/secret");
        CHECK(pointer_of(R"({"url": "http://x/", "secret": ")" + secret +
                         R"(", "events": ["job.lost"]})") == "/webhook/events/0");
        CHECK(pointer_of(R"({"url": "http://x/", "secret": ")" + secret +
                         R"(", "events": ["batch.finished"]})") == "/webhook/events/0");
        CHECK(pointer_of(R"({"url": "http://x/", "secret": ")" + secret + R"(", "more": 1})") ==
              "/webhook/more");
    }

    TEST_CASE("names of events lead back to the events") {
        const std::vector<WebhookEvent> events{WebhookEvent::job_failed,
                                               WebhookEvent::job_succeeded};
        CHECK(event_names(events) == "job.failed job.succeeded");
        CHECK(named_events("job.failed job.succeeded") == events);
        CHECK(named_events("").empty());
    }

    TEST_CASE("the secret is shown once") {
        const Webhook webhook{"W", "https://u", "whsec_s", {WebhookEvent::job_failed}, 0};
        const std::string shown = R"({"id":"W","url":"https://u","events":["job.failed"],)"
                                  R"("created_at":"1970-01-01T00:00:00.000Z")";
        CHECK(to_json(webhook, false) == shown + "}");
        CHECK(to_json(webhook, true) == shown + R"(,"secret":"whsec_s"})");
        CHECK(to_json(std::vector{webhook}) == R"({"items":[)" + shown + "}]}");
    }

    TEST_CASE("a message tells of a job's end, or is a test") {
        const WebhookMessage ended{0, JobEnded{"J", JobState::succeeded, "order", "B"}};
        CHECK(to_json(ended) ==
              R"({"type":"job.succeeded","timestamp":"1970-01-01T00:00:00.000Z",)"
              R"("data":{"id":"J","state":"succeeded","tag":"order","batch":"B"}})");
        CHECK(to_json(WebhookMessage{0, BatchFinished{"B", {{JobState::failed, 2}}}}) ==
              R"({"type":"batch.finished","timestamp":"1970-01-01T00:00:00.000Z",)"
              R"("data":{"batch":"B","states":{"failed":2}}})");
        CHECK(to_json(WebhookMessage{0, WebhookTest{"W"}}) ==
              R"({"type":"test","timestamp":"1970-01-01T00:00:00.000Z","data":{"webhook":"W"}})");
    }

    TEST_CASE("a delivery shows what was sent, and what came of it") {
        Delivery delivery;
        delivery.id = "msg_1";
        delivery.event = "test";
        delivery.payload = R"({"type":"test"})";
        delivery.attempt = 1;
        delivery.error = "no connection";
        delivery.next_ms = 5000;
        CHECK(to_json(std::vector{delivery}) ==
              R"({"items":[{"id":"msg_1","event":"test",)"
              R"("created_at":"1970-01-01T00:00:00.000Z","attempt":1,"delivered":false,)"
              R"("error":"no connection","next_attempt_at":"1970-01-01T00:00:05.000Z",)"
              R"("payload":{"type":"test"}}]})");
    }
}

}  // namespace lastflat::api
