#include "server/routes/access.h"

#include <doctest/doctest.h>

#include "api/object_reader.h"
#include "api/timestamp.h"
#include "core/error.h"
#include "server/routes/answers.h"
#include "server/routes/own_machine.h"
#include "server/storage/sqlite_accounts.h"
#include "server/storage/sqlite_store.h"
#include "server/support/clock.h"
#include "server/support/duration.h"
#include "server/support/files.h"
#include "server/support/metrics.h"
#include "tests/helpers/temporary_folder.h"

namespace lastflat::server {
namespace {

struct AccessSetting {
    lastflat::test::TemporaryFolder folder;
    SqliteDatabase database{folder.path() / "jobs.sqlite"};
    SqliteKeys keys{database};
    SqliteStore jobs{database, {}};
    const Tokens tokens{keys.secret("tokens")};
    Access access;

    explicit AccessSetting(AccessRules rules = {}) : access(keys, jobs, tokens, std::move(rules)) {}

    static http::Request request(const std::string& key, const std::string& from = "127.0.0.1",
                                 const std::string& path = "/v1/jobs") {
        http::Request request;
        request.method = "GET";
        request.path = path;
        request.remote_address = from;
        if (!key.empty()) request.headers["authorization"] = "Bearer " + key;
        return request;
    }
    /// The code of what it is refused with; empty: it is not.
    std::string code(http::Request request) {
        try {
            access.admit(request);
            return {};
        } catch (const api::Refusal& refusal) {
            return std::string(refusal.problem().code.word());
        }
    }
    int status(http::Request request) {
        try {
            access.admit(request);
            return 200;
        } catch (const api::Refusal& refusal) {
            return refusal.problem().status;
        }
    }
};

const std::string some_job(26, '0'), some_asset(64, 'a');

/// With a token in the query.
http::Request with_token(const std::string& token, const std::string& method,
                         const std::string& path) {
    http::Request request = AccessSetting::request("", "10.0.0.9", path);
    request.method = method;
    request.query["token"] = token;
    return request;
}

std::string header(const http::Request& request, const std::string& name) {
    for (const auto& [n, value] : request.answer_headers) {
        if (n == name) return value;
    }
    return {};
}

}  // namespace

TEST_SUITE("server/routes/access") {
    TEST_CASE("a key does what it is for, as long as it is for") {
        AccessSetting s;
        const std::string look = s.keys.add({"look", KeyScope::read}),
                          work = s.keys.add({"work", KeyScope::jobs}),
                          over = s.keys.add({"over", KeyScope::all, now_ms() - 1});
        const auto asked = [&](const std::string& key, const char* method, const char* path) {
            http::Request request = s.request(key, "10.0.0.9", path);
            request.method = method;
            return s.code(request);
        };
        CHECK(asked(look, "GET", "/v1/jobs") == "");
        CHECK(asked(look, "POST", "/v1/jobs/ID/map") == "");
        for (const char* path : {"/v1/jobs", "/v1/assets", "/v1/validate", "/v1/tokens"})
            CHECK(asked(look, "POST", path) == "scope_refused");
        for (const char* path : {"/v1/jobs", "/v1/jobs:batch", "/v1/assets", "/v1/validate",
                                 "/v1/jobs/ID/cancel", "/v1/batches/ID/cancel"})
            CHECK(asked(work, "POST", path) == "");
        CHECK(asked(work, "DELETE", "/v1/jobs/ID") == "scope_refused");
        CHECK(asked(work, "POST", "/v1/webhooks") == "scope_refused");
        CHECK(asked(work, "POST", "/v1/tokens") == "scope_refused");
        CHECK(asked(work, "GET", "/v1/webhooks") == "scope_refused");
        CHECK(asked(look, "GET", "/v1/webhooks") == "scope_refused");
        CHECK(asked(over, "GET", "/v1/jobs") == "key_unknown");
    }

    TEST_CASE("a token does one thing, for a while, and dies with its key") {
        AccessSetting s;
        const std::string key = s.keys.add({"one"});
        const std::string id = s.keys.check(key)->id;
        const auto token = [&](const std::string& scope, std::int64_t ms = 60'000) {
            return s.tokens.sealed({id, scope, now_ms() + ms});
        };
        const std::string job = token("job:" + some_job), path = "/v1/jobs/" + some_job;
        http::Request request = with_token(job, "GET", path + "/events");
        CHECK_NOTHROW(s.access.admit(request));
        CHECK(request.principal == id);
        CHECK(s.code(s.request(job, "10.0.0.9", path + "/result")) == "");
        CHECK(s.code(with_token(job, "POST", path + "/map")) == "");
        CHECK(s.code(with_token(job, "POST", path + "/cancel")) == "scope_refused");
        CHECK(s.code(with_token(job, "DELETE", path)) == "scope_refused");
        CHECK(s.code(with_token(job, "GET", path + "0")) == "scope_refused");
        CHECK(s.code(with_token(job, "GET", "/v1/jobs")) == "scope_refused");
        CHECK(s.code(with_token(job, "POST", "/v1/tokens")) == "scope_refused");

        const std::string submit = token("submit");
        for (const char* to : {"/v1/jobs", "/v1/assets", "/v1/validate"}) {
            CHECK(s.code(with_token(submit, "POST", to)) == "");
            CHECK(s.code(with_token(submit, "GET", to)) == "scope_refused");
        }
        CHECK(s.code(with_token(submit, "POST", "/v1/tokens")) == "scope_refused");

        std::string other = job;
        other[Tokens::prefix.size() + 20] ^= 1;
        const std::string key_in_query = key;
        for (const std::string& wrong :
             {other, job.substr(0, job.size() - 1), job + "x", token("submit", -1), key_in_query,
              std::string(), std::string(Tokens::prefix),
              Tokens("another").sealed({id, "submit", now_ms() + 60'000}),
              s.tokens.sealed({"nobody", "submit", now_ms() + 60'000}),
              s.tokens.sealed({"", "submit", now_ms() + 60'000})})
            CHECK(s.code(with_token(wrong, "POST", "/v1/jobs")) == "token_invalid");
        REQUIRE(s.keys.revoke(id));
        CHECK(s.code(with_token(job, "GET", path)) == "token_invalid");
    }

    TEST_CASE("a token of an asset makes jobs of it and follows those") {
        AccessSetting s;
        const std::string id = s.keys.check(s.keys.add({"one"}))->id;
        NewJob own;
        own.id = some_job;
        own.owner = id;
        own.model = some_asset;
        NewJob others = own;
        others.id = std::string(26, '1');
        others.model = std::string(64, 'b');
        REQUIRE(s.jobs.add(own, {}).admission == Admission::queued);
        REQUIRE(s.jobs.add(others, {}).admission == Admission::queued);
        const std::string token = s.tokens.sealed({id, "asset:" + some_asset, now_ms() + 60'000});
        http::Request submission = with_token(token, "POST", "/v1/jobs");
        CHECK_NOTHROW(s.access.admit(submission));
        CHECK(submission.restriction == some_asset);
        CHECK(s.code(with_token(token, "GET", "/v1/assets/" + some_asset)) == "");
        CHECK(s.code(with_token(token, "DELETE", "/v1/assets/" + some_asset)) == "scope_refused");
        CHECK(s.code(with_token(token, "GET", "/v1/jobs/" + own.id + "/result")) == "");
        CHECK(s.code(with_token(token, "POST", "/v1/jobs/" + own.id + "/cancel")) == "");
        CHECK(s.code(with_token(token, "GET", "/v1/jobs/" + others.id)) == "scope_refused");
        CHECK(s.code(with_token(token, "POST", "/v1/jobs:batch")) == "scope_refused");
    }

    TEST_CASE("a token for web pages is used by those alone") {
        AccessSetting s;
        const std::string id = s.keys.check(s.keys.add({"one"}))->id;
        const std::string token =
            s.tokens.sealed({id, "submit", now_ms() + 60'000, {"https://shop.example"}});
        const auto from = [&](const char* name, const char* value) {
            http::Request request = with_token(token, "POST", "/v1/jobs");
            request.headers[name] = value;
            return s.code(request);
        };
        CHECK(from("origin", "https://shop.example") == "");
        CHECK(from("referer", "https://shop.example/last/4711") == "");
        CHECK(from("referer", "https://shop.example") == "");
        CHECK(from("origin", "https://evil.example") == "origin_refused");
        CHECK(from("referer", "https://shop.example.evil/") == "origin_refused");
        CHECK(from("accept", "*/*") == "origin_refused");
    }

    TEST_CASE("tokens of an open service are good while it is open") {
        AccessSetting s;
        const std::string token = s.tokens.sealed({"", "submit", now_ms() + 60'000});
        http::Request here = with_token(token, "POST", "/v1/jobs");
        CHECK(s.code(here) == "no_keys");  // it is not this machine
        here.remote_address = "127.0.0.1";
        CHECK(s.code(here) == "");
        (void)s.keys.add({"one"});
        CHECK(s.code(here) == "token_invalid");
    }

    TEST_CASE("without a key, this machine is answered and no other; with one, its bearer alone") {
        AccessSetting s;
        CHECK(s.status(s.request("")) == 200);
        CHECK(s.status(s.request("", "::1")) == 200);
        CHECK(s.status(s.request("", "::ffff:127.0.0.1")) == 200);
        CHECK(s.status(s.request("", "192.168.0.7")) == 401);
        CHECK(s.status(s.request("", "1270.0.0.1")) == 401);
        for (const char* by : {"x-forwarded-for", "x-forwarded-proto", "x-real-ip", "via",
                               "forwarded", "cf-connecting-ip", "true-client-ip"}) {
            CAPTURE(by);
            http::Request proxied = s.request("");
            proxied.headers[by] = "203.0.113.9";
            CHECK(s.status(proxied) == 401);
        }
        const std::string key = s.keys.add({"one"});
        CHECK(s.status(s.request("")) == 401);
        CHECK(s.status(s.request("wrong")) == 401);
        CHECK(s.status(s.request(key, "192.168.0.7")) == 200);
        http::Request loud = s.request("");
        loud.headers["authorization"] = "BEARER " + key;
        CHECK(s.status(loud) == 200);
        http::Request basic = s.request("");
        basic.headers["authorization"] = "Basic " + key;
        CHECK(s.status(basic) == 401);
        CHECK(s.status(s.request("", "192.168.0.7", "/healthz")) == 200);
        CHECK(s.keys.revoke(s.keys.list().at(0).id));
        CHECK(s.status(s.request(key, "192.168.0.7")) == 401);
        CHECK(s.status(s.request("")) == 401);  // with its last key revoked it does not open again
    }

    TEST_CASE("without a key, a page of another origin or under another name is refused") {
        AccessSetting s({0, {"https://studio.example"}, "10.1.2.3"});
        const auto with = [&](const std::string& host, const std::string& name = "",
                              const std::string& value = "", const std::string& key = "") {
            http::Request request = s.request(key);
            request.headers["host"] = host;
            if (!name.empty()) request.headers[name] = value;
            return s.status(request);
        };
        for (const char* own : {"localhost", "LOCALHOST:8080", "last.localhost:8080", "127.0.0.1",
                                "127.1.2.3:80", "[::1]:8080", "10.1.2.3:8080"}) {
            CAPTURE(own);
            CHECK(with(own) == 200);
        }
        for (const char* other : {"evil.example", "evil.example:8080", "127.0.0.1.evil.example",
                                  "localhost.evil.example", "notlocalhost", "10.1.2.4", "[::2]"}) {
            CAPTURE(other);
            CHECK(with(other) == 403);
        }
        CHECK(with("localhost:8080", "origin", "http://localhost:8080") == 200);
        CHECK(with("localhost:8080", "origin", "https://studio.example") == 200);
        CHECK(with("localhost:8080", "sec-fetch-site", "same-origin") == 200);
        for (const char* foreign :
             {"https://evil.example", "null", "http://localhost:8080.evil.example",
              "http://localhost:3000"}) {
            CAPTURE(foreign);
            CHECK(with("localhost:8080", "origin", foreign) == 403);
        }
        CHECK(with("localhost:8080", "sec-fetch-site", "cross-site") == 403);
        http::Request page = s.request("", "127.0.0.1", "/docs");
        page.headers["sec-fetch-site"] = "cross-site";
        CHECK(s.status(page) == 200);
        const std::string key = s.keys.add({"one"});
        CHECK(with("lasts.example", "origin", "https://evil.example", key) == 200);
    }

    TEST_CASE("this machine goes by its loopback addresses and by names that end in localhost") {
        for (const char* own : {"127.0.0.1", "127.9.9.9", "::1", "::ffff:127.0.0.1", "localhost"})
            CHECK(is_loopback(own));
        for (const char* other : {"", "0.0.0.0", "10.0.0.1", "127.evil.example", "::ffff:10.0.0.1"})
            CHECK_FALSE(is_loopback(other));
    }

    TEST_CASE("a key has its rate, says what is left, and shares it with nobody") {
        AccessSetting s({3, {}, ""});
        const std::string one = s.keys.add({"one"}), two = s.keys.add({"two"});
        http::Request first = s.request(one);
        s.access.admit(first);
        CHECK(header(first, "RateLimit-Policy") == "\"default\";q=3;w=60");
        CHECK(header(first, "RateLimit").rfind("\"default\";r=2;t=", 0) == 0);
        CHECK(s.status(s.request(one)) == 200);
        CHECK(s.status(s.request(one)) == 200);
        http::Request over = s.request(one);
        CHECK(s.status(over) == 429);
        CHECK(s.status(s.request(two)) == 200);
    }

    TEST_CASE("only the web pages that are allowed may call") {
        AccessSetting s({0, {"https://studio.example"}, ""});
        const std::string key = s.keys.add({"one"});
        const auto allowed = [&](const char* origin) {
            http::Request request = s.request(key);
            request.headers["origin"] = origin;
            s.access.admit(request);
            return header(request, "Access-Control-Allow-Origin");
        };
        CHECK(allowed("https://studio.example") == "https://studio.example");
        CHECK(allowed("https://studio.example.evil") == "");
        CHECK(allowed("null") == "");
    }
}

TEST_SUITE("server/routes/answers") {
    TEST_CASE("what is thrown becomes its problem, with the headers that go with it") {
        const auto answer = [](const auto& thrown) {
            http::Response response = answer_to({}, std::make_exception_ptr(thrown));
            std::string text = std::to_string(response.status);
            for (const auto& [name, value] : response.headers) {
                if (name != "Cache-Control") text += " " + name + ": " + value;
            }
            return text;
        };
        CHECK(answer(api::Refusal("key_missing", "none")) == "401 WWW-Authenticate: Bearer");
        CHECK(answer(api::Refusal("not_finished", "wait")) == "409 Retry-After: 1");
        CHECK(answer(StoreError("disk")) == "503 Retry-After: 5");
        CHECK(answer(api::Refusal("server_busy", "wait").with_header("Retry-After", "9")) ==
              "503 Retry-After: 9");
        CHECK(answer(api::InvalidRequest("/lock", "unknown")) == "422");
        CHECK(answer(Error(ErrorCode::model_too_large, "large")) == "413");
    }

    TEST_CASE("a client is not told why the service failed") {
        for (const auto& thrown : {std::make_exception_ptr(std::logic_error("the secret")),
                                   std::make_exception_ptr(StoreError("the secret"))}) {
            const http::Response response = answer_to({}, thrown);
            CHECK(response.status >= 500);
            CHECK(response.body->find("the secret") == std::string::npos);
        }
    }

    TEST_CASE("tags are compared weakly, and a list of them too") {
        http::Request request;
        CHECK_FALSE(has_already(request, "\"a\""));
        request.headers["if-none-match"] = "\"x\", W/\"a\"";
        CHECK(has_already(request, "\"a\""));
        CHECK(has_already(request, "W/\"x\""));
        CHECK_FALSE(has_already(request, "\"b\""));
        request.headers["if-none-match"] = "*";
        CHECK(has_already(request, "\"b\""));
    }

    TEST_CASE("a preference to wait is read, bounded, and never an error") {
        const auto wait = [](const char* prefer) {
            http::Request request;
            request.headers["prefer"] = prefer;
            return preferred_wait(request).value_or(-1);
        };
        CHECK(wait("wait=5") == 5);
        CHECK(wait("respond-async, wait=100") == 60);
        for (const char* none : {"", "wait", "wait=", "wait=x", "wait=-1", "wait=5x"})
            CHECK(wait(none) == -1);
    }
}

TEST_SUITE("server/support/duration") {
    TEST_CASE("durations are numbers with a unit") {
        CHECK(duration_ms("90") == 90'000);
        CHECK(duration_ms("90s") == 90'000);
        CHECK(duration_ms("2m") == 120'000);
        CHECK(duration_ms("1h") == 3'600'000);
        CHECK(duration_ms("7d") == 604'800'000);
        for (const char* none : {"", "s", "-1s", "1.5h", "2 m", "1w", "99999999999"})
            CHECK_FALSE(duration_ms(none).has_value());
    }

    TEST_CASE("times on the wire are read back as they were written") {
        for (const std::int64_t ms : {0LL, 1'709'251'199'123LL, 1'795'535'560'885LL})
            CHECK(api::rfc3339_ms(api::rfc3339(ms)) == ms);
        CHECK(api::rfc3339_ms("2026-03-01T08:00:00Z") == 1'772'352'000'000);
        CHECK(api::rfc3339_ms("2026-03-01T08:00:00.5Z") == 1'772'352'000'500);
        for (const char* none :
             {"", "today", "2026-03-01", "2026-03-01T08:00:00", "2026-03-01T08:00:00+01:00"})
            CHECK_FALSE(api::rfc3339_ms(none).has_value());
    }
}

TEST_SUITE("server/support/metrics") {
    TEST_CASE("counters add, histograms cumulate, labels are escaped") {
        Metrics metrics;
        metrics.count("lastflat_http_requests_total", {{"route", "a\"b\\c\nd"}});
        metrics.count("lastflat_http_requests_total", {{"route", "a\"b\\c\nd"}}, 2);
        metrics.observe("lastflat_job_seconds", 0.02, {{"outcome", "succeeded"}});
        metrics.observe("lastflat_job_seconds", 5.0, {{"outcome", "succeeded"}});
        const std::string text = metrics.text();
        for (const char* line :
             {"# TYPE lastflat_job_seconds histogram\n",
              "lastflat_http_requests_total{route=\"a\\\"b\\\\c\\nd\"} 3\n",
              "lastflat_job_seconds_bucket{outcome=\"succeeded\",le=\"0.01\"} 0\n",
              "lastflat_job_seconds_bucket{outcome=\"succeeded\",le=\"0.03\"} 1\n",
              "lastflat_job_seconds_bucket{outcome=\"succeeded\",le=\"+Inf\"} 2\n",
              "lastflat_job_seconds_count{outcome=\"succeeded\"} 2\n"}) {
            CAPTURE(line);
            CHECK(text.find(line) != std::string::npos);
        }
    }
}

}  // namespace lastflat::server
