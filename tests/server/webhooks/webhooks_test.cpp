#include <arpa/inet.h>
#include <doctest/doctest.h>

#include <atomic>
#include <cstring>

#include "server/jobs/job.h"
#include "server/storage/sqlite_webhooks.h"
#include "server/support/clock.h"
#include "server/webhooks/dispatcher.h"
#include "server/webhooks/private_address.h"
#include "tests/helpers/eventually.h"
#include "tests/server/storage/test_store.h"

namespace lastflat::server {
namespace {

bool private_address(const char* text) {
    sockaddr_storage storage{};
    auto& v4 = reinterpret_cast<sockaddr_in&>(storage);
    auto& v6 = reinterpret_cast<sockaddr_in6&>(storage);
    if (inet_pton(AF_INET, text, &v4.sin_addr) == 1) {
        v4.sin_family = AF_INET;
    } else {
        REQUIRE(inet_pton(AF_INET6, text, &v6.sin6_addr) == 1);
        v6.sin6_family = AF_INET6;
    }
    return is_private(reinterpret_cast<sockaddr&>(storage));
}

Webhook webhook(const std::string& id, const std::string& owner, const std::string& events) {
    return {{id, "http://127.0.0.1:9/", "whsec_AAAA", api::named_events(events), 0}, owner};
}

}  // namespace

TEST_SUITE("server/webhooks/private_address") {
    TEST_CASE("addresses inside are private, in every way to write them") {
        for (const char* inside : {"127.0.0.1",
                                   "127.255.0.9",
                                   "10.1.2.3",
                                   "172.16.0.1",
                                   "172.31.255.255",
                                   "192.168.1.1",
                                   "169.254.169.254",
                                   "100.64.0.1",
                                   "0.0.0.0",
                                   "224.0.0.1",
                                   "255.255.255.255",
                                   "::1",
                                   "::",
                                   "fe80::1",
                                   "fd00::1",
                                   "fc00::1",
                                   "ff02::1",
                                   "::ffff:10.0.0.1",
                                   "::ffff:127.0.0.1",
                                   "64:ff9b::a00:1",
                                   "2002:a00:1::",
                                   "2001:db8::1",
                                   "2001:0:1::1"}) {
            CAPTURE(inside);
            CHECK(private_address(inside));
        }
        for (const char* outside :
             {"1.1.1.1", "93.184.216.34", "172.32.0.1", "172.15.0.1", "192.169.0.1", "11.0.0.1",
              "100.128.0.1", "2606:4700::1111", "2002:101:101::", "::ffff:8.8.8.8"}) {
            CAPTURE(outside);
            CHECK_FALSE(private_address(outside));
        }
    }
}

TEST_SUITE("server/webhooks/post_message") {
    TEST_CASE("a message is signed as the standard's own example") {
        // Standard Webhooks, reference libraries' test vector.
        CHECK(signature("whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw", "msg_p5jXN8AQM9LWM0D4loKWxJek",
                        1614265330, "{\"test\": 2432232314}") ==
              "v1,g0hM9SsE+OTPJTGt/tmIKtSyZlE3uFJELVlNIOLJ1OE=");
    }

    TEST_CASE("only http and https without a user name are addresses") {
        for (const char* good : {"http://a/", "https://a.example:8443/b?c=d", "http://[::1]/"})
            CHECK(is_webhook_url(good));
        for (const char* bad : {"", "a", "ftp://a/", "file:///etc/passwd", "http://u@a/",
                                "http://u:w@a/", "javascript:1"})
            CHECK_FALSE(is_webhook_url(bad));
    }
}

TEST_SUITE("server/webhooks/dispatcher") {
    TEST_CASE("pauses grow, and end") {
        std::int64_t before = 0;
        int attempts = 1;
        while (const auto wait = back_off_ms(attempts)) {
            CHECK(*wait > before);
            before = *wait;
            ++attempts;
        }
        CHECK(attempts == 9);
        CHECK_FALSE(back_off_ms(0).has_value());
    }

    TEST_CASE("the end of a job makes one message for each webhook that wants it") {
        test::TestStore s;
        SqliteWebhooks webhooks(s.database);
        webhooks.add(webhook("all", "key", "job.succeeded job.failed job.canceled"));
        webhooks.add(webhook("failures", "key", "job.failed"));
        webhooks.add(webhook("others", "another key", "job.succeeded"));
        REQUIRE(s.add(test::new_job("A", "key")) == Admission::queued);
        REQUIRE(s.add(test::new_job("B", "key")) == Admission::queued);
        CHECK(webhooks.deliveries("key", "all").empty());
        CHECK(s.store.finish(s.store.claim(60'000)->lease, test::success()));
        CHECK(s.store.cancel("key", "B") == JobState::canceled);
        const auto sent = webhooks.deliveries("key", "all");
        REQUIRE(sent.size() == 2);
        CHECK(sent[0].event == "job.canceled");
        CHECK(sent[1].event == "job.succeeded");
        CHECK(sent[1].payload.find("\"id\":\"A\"") != std::string::npos);
        CHECK(webhooks.deliveries("key", "failures").empty());
        CHECK(webhooks.deliveries("another key", "others").empty());
        CHECK_FALSE(webhooks.remove("another key", "all"));
        CHECK(webhooks.remove("key", "all"));
        CHECK(webhooks.deliveries("key", "all").empty());
        CHECK_FALSE(webhooks.claim(1000, 4).has_value());
    }

    TEST_CASE("the end of a batch is told once, after its last job's") {
        test::TestStore s;
        SqliteWebhooks webhooks(s.database);
        webhooks.add(webhook("all", "key", "job.succeeded job.failed job.canceled batch.finished"));
        NewBatch batch{"B", "key", "print", "", {}};
        for (const char* id : {"A", "C"}) {
            batch.jobs.push_back(test::new_job(id, "key"));
            batch.jobs.back().batch = "B";
        }
        REQUIRE(s.store.add(batch, {}).admission == Admission::queued);
        CHECK(s.store.cancel("key", "A"));
        CHECK(webhooks.deliveries("key", "all").size() == 1);
        CHECK(s.store.finish(s.store.claim(60'000)->lease, test::failure()));
        const auto sent = webhooks.deliveries("key", "all");
        REQUIRE(sent.size() == 3);
        CHECK(sent[0].event == "batch.finished");
        CHECK(sent[0].payload.find(R"("states":{"failed":1,"canceled":1})") != std::string::npos);
        for (const auto& message : sent)
            CHECK(message.payload.find(R"("batch":"B")") != std::string::npos);
        CHECK(s.store.remove("key", "A"));
        CHECK(webhooks.deliveries("key", "all").size() == 3);
    }

    TEST_CASE("a job's own webhook is told of that job alone, and goes with it") {
        test::TestStore s;
        SqliteWebhooks webhooks(s.database);
        NewJob job = test::new_job("A", "key");
        job.webhook =
            api::WebhookRequest{"http://example.com/", {api::WebhookEvent::job_canceled}, "whsec_"};
        REQUIRE(s.add(job) == Admission::queued);
        REQUIRE(s.add(job) == Admission::repeated);
        REQUIRE(s.add(test::new_job("B", "key")) == Admission::queued);
        for (const char* id : {"A", "B"}) CHECK(s.store.cancel("key", id) == JobState::canceled);
        REQUIRE(webhooks.deliveries("key", "A").size() == 1);
        CHECK(webhooks.list("key").empty());
        CHECK(webhooks.find("key", "A").value().url == "http://example.com/");
        CHECK_FALSE(webhooks.find("another key", "A").has_value());
        CHECK(webhooks.claim(1000, 4).value().delivery.event == "job.canceled");
        CHECK(s.store.remove("key", "A"));
        CHECK_FALSE(webhooks.find("key", "A").has_value());
        CHECK(webhooks.deliveries("key", "A").empty());
    }

    TEST_CASE("a job that has the id of a webhook does not touch it") {
        test::TestStore s;
        SqliteWebhooks webhooks(s.database);
        webhooks.add(webhook("A", "key", "job.failed"));
        NewJob job = test::new_job("A", "key");
        job.webhook =
            api::WebhookRequest{"http://example.com/", {api::WebhookEvent::job_failed}, "whsec_"};
        CHECK(s.add(job) == Admission::id_taken);
        job.webhook.reset();
        REQUIRE(s.add(job) == Admission::queued);
        CHECK(s.store.remove("key", "A"));
        CHECK(webhooks.find("key", "A").has_value());
        NewJob other = test::new_job("A", "another key");
        other.webhook =
            api::WebhookRequest{"http://example.com/", {api::WebhookEvent::job_failed}, "whsec_"};
        REQUIRE(s.add(other) == Admission::queued);
        CHECK(s.store.remove("another key", "A"));
        CHECK(webhooks.find("key", "A").has_value());
    }

    TEST_CASE("owners take turns, and none has all messages on the way") {
        test::TestStore s;
        SqliteWebhooks webhooks(s.database);
        webhooks.add(webhook("A", "one", "job.failed"));
        webhooks.add(webhook("B", "two", "job.failed"));
        for (int i = 0; i < 4; ++i) REQUIRE(webhooks.add_test("one", "A"));
        REQUIRE(webhooks.add_test("two", "B"));
        std::string order;
        while (const auto due = webhooks.claim(60'000, 3)) order += due->webhook.id;
        CHECK(order == "ABAA");
    }

    TEST_CASE("a receiver that does not answer gets one message at a time, later and later") {
        test::TestStore s;
        SqliteWebhooks webhooks(s.database);
        webhooks.add(webhook("A", "one", "job.failed"));
        for (int i = 0; i < 3; ++i) REQUIRE(webhooks.add_test("one", "A"));
        const auto settle = [&](Delivery delivery, int status) {
            delivery.status = status;
            delivery.next_ms = now_ms();
            webhooks.settle(delivery);
        };
        const auto wait_of_next = [&] {
            std::int64_t next = 0;
            for (const Delivery& delivery : webhooks.deliveries("one", "A"))
                next = std::max(next, delivery.next_ms.value());
            return next - now_ms();
        };
        settle(webhooks.claim(60'000, 4).value().delivery, 0);
        CHECK_FALSE(webhooks.claim(60'000, 4).has_value());
        CHECK(wait_of_next() > 4'000);
        CHECK(wait_of_next() <= 5'000);
        s.database.write([](SqliteConnection& connection) {
            Query(connection.prepared("UPDATE deliveries SET next_ms = 1")).run();
        });
        const auto probe = webhooks.claim(60'000, 4).value();
        CHECK_FALSE(webhooks.claim(60'000, 4).has_value());  // while that one is tried
        settle(probe.delivery, 0);
        CHECK(wait_of_next() > 9'000);
        settle(probe.delivery, 500);  // an answer, if not a good one
        CHECK(wait_of_next() <= 0);
        for (int i = 0; i < 3; ++i) CHECK(webhooks.claim(60'000, 4).has_value());
    }

    TEST_CASE("what fails is tried again later, what arrives is not, and 410 ends it") {
        test::TestStore s;
        SqliteWebhooks webhooks(s.database);
        for (const char* id : {"good", "broken", "gone"}) {
            webhooks.add(webhook(id, "", "job.failed"));
            CHECK(webhooks.add_test("", id));
        }
        std::atomic<int> posts{0};
        {
            const WebhookDispatcher dispatcher(webhooks, [&](const DueDelivery& due) {
                ++posts;
                const std::string& id = due.webhook.id;
                return PostOutcome{id == "good" ? 204 : id == "gone" ? 410 : 500, "said"};
            });
            REQUIRE(lastflat::test::eventually([&] { return posts == 3; }));
        }
        CHECK(posts == 3);
        CHECK(webhooks.deliveries("", "good").at(0).delivered);
        CHECK_FALSE(webhooks.deliveries("", "good").at(0).next_ms.has_value());
        const Delivery broken = webhooks.deliveries("", "broken").at(0);
        CHECK_FALSE(broken.delivered);
        CHECK(broken.next_ms.value() > now_ms());
        CHECK(broken.status == 500);
        CHECK_FALSE(webhooks.deliveries("", "gone").at(0).next_ms.has_value());
    }
}

}  // namespace lastflat::server
