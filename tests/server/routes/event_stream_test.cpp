#include "server/routes/event_stream.h"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "server/routes/answers.h"
#include "server/support/crypto.h"
#include "tests/server/jobs/memory_blobs.h"
#include "tests/server/storage/test_store.h"

namespace lastflat::server {
namespace {

using test::new_job;

constexpr JobNumber first_job = 1;  ///< of the job that a test adds first

/// A waiting room with so many seats.
class Seats final : public http::WaitingRoom {
public:
    explicit Seats(int free) : free_(free) {}
    bool enter() override {
        if (free_ == 0) return false;
        --free_;
        return true;
    }
    void leave() override { ++free_; }
    [[nodiscard]] int free() const { return free_; }

private:
    int free_;
};

/// What the route needs, and a waiting room with one seat.
struct StreamSetting : test::TestStore {
    test::MemoryBlobs blobs;
    JobWatch watch;
    Estimate estimate;
    JobView view{watch, estimate, 1};
    SeatsByKey seats_by_key{64};
    Seats seats{1};
    http::Handler handler = event_route({store, blobs, watch, view, seats_by_key}).handler;

    http::Request request(const std::string& id, const std::string& owner = "") {
        http::Request request;
        request.method = "GET";
        request.captures = {id};
        request.principal = owner;
        request.waiting_room = &seats;
        return request;
    }
};

/// One client's stream, read step by step.
struct Watcher {
    http::Response response;
    bool goes_on = true;

    Watcher(StreamSetting& s, const http::Request& request) : response(s.handler(request)) {}

    /// What the next step sends.
    std::string next() {
        std::string sent;
        goes_on = response.stream([&](std::string_view bytes) {
            sent += bytes;
            return true;
        });
        return sent;
    }
};

http::Response answer(StreamSetting& s, const http::Request& request) {
    try {
        return s.handler(request);
    } catch (...) {
        return answer_to(request, std::current_exception());
    }
}

int status_of(StreamSetting& s, const http::Request& request) {
    return answer(s, request).status;
}

std::string code_of(StreamSetting& s, const http::Request& request) {
    return nlohmann::json::parse(*answer(s, request).body).at("code");
}

/// The events' names in order, with what follows "field": in the data of each.
std::string summary(const std::string& stream, const std::string& field = "state") {
    std::string text;
    std::size_t at = 0;
    while ((at = stream.find("event: ", at)) != std::string::npos) {
        text += (text.empty() ? "" : " ") + stream.substr(at + 7, stream.find('\n', at) - at - 7);
        const std::size_t data = stream.find("\ndata: ", at) + 7;
        const auto json =
            nlohmann::json::parse(stream.substr(data, stream.find('\n', data) - data));
        if (json.contains(field)) text += "=" + json.at(field).dump();
        at = data;
    }
    return text;
}

std::int64_t last_id(const std::string& stream) {
    const std::size_t at = stream.rfind("\nid: ");
    REQUIRE(at != std::string::npos);
    return std::stoll(stream.substr(at + 5));
}

/// A result that says no more than its metrics.
JobEnd result_with(const BlobStore& blobs, const std::string& metrics) {
    return Succeeded{blobs.put(metrics), {{"metrics", 0, metrics.size(), sha256(metrics)}}};
}

constexpr char quiet_metrics[] = R"({"repairs": [], "warnings": []})";

}  // namespace

TEST_SUITE("server/routes/event_stream") {
    TEST_CASE("who watches from the beginning sees every state once, the progress, and the end") {
        StreamSetting s;
        REQUIRE(s.add(new_job("A")) == Admission::queued);
        Watcher watcher(s, s.request("A"));
        CHECK(watcher.response.status == 200);
        CHECK(watcher.response.media_type == "text/event-stream");
        const std::string first = watcher.next();
        CHECK(first.starts_with("retry: "));
        CHECK(summary(first) == R"(state="queued")");

        const Claim claim = s.store.claim(60'000).value();
        s.watch.changed(first_job);
        CHECK(summary(watcher.next()) == R"(state="running")");
        s.watch.reach(first_job, "cut", 0.256);
        const std::string progress = watcher.next();
        CHECK(summary(progress, "stage") == R"(progress="cut")");
        CHECK(summary(progress, "percent") == "progress=25");
        s.watch.changed(first_job);  // nothing that a client would see
        CHECK(watcher.next().empty());
        CHECK(watcher.goes_on);

        REQUIRE(s.store.finish(claim.lease, result_with(s.blobs, quiet_metrics)));
        s.watch.ended(first_job);
        CHECK(summary(watcher.next()) == R"(state="succeeded" done="succeeded")");
        CHECK_FALSE(watcher.goes_on);
    }

    TEST_CASE("who comes back sees what came after the event that it names") {
        StreamSetting s;
        REQUIRE(s.add(new_job("A")) == Admission::queued);
        const std::int64_t queued = last_id(Watcher(s, s.request("A")).next());
        const Claim claim = s.store.claim(60'000).value();
        REQUIRE(s.store.finish(claim.lease, test::failure()));
        http::Request request = s.request("A");
        request.headers["last-event-id"] = std::to_string(queued);
        Watcher watcher(s, request);
        const std::string rest = watcher.next();
        CHECK(summary(rest) == R"(state="running" state="failed" done="failed")");
        CHECK_FALSE(watcher.goes_on);
        watcher.response = {};
        request.headers["last-event-id"] = std::to_string(last_id(rest));
        CHECK(status_of(s, request) == 204);  // it has seen the end: nothing to ask for again
        request.headers["last-event-id"] = "no number";
        CHECK(summary(Watcher(s, request).next()) ==
              R"(state="queued" state="running" state="failed" done="failed")");
    }

    TEST_CASE("a job that is begun again shows its progress from the start") {
        StreamSetting s;
        REQUIRE(s.add(new_job("A")) == Admission::queued);
        const Claim claim = s.store.claim(60'000).value();
        s.watch.reach(first_job, "cut", 0.25);
        Watcher watcher(s, s.request("A"));
        CHECK(summary(watcher.next(), "stage") == R"(state state progress="cut")");
        REQUIRE(s.store.release(claim.lease, Release::lost));
        s.watch.ended(first_job);
        REQUIRE(s.store.claim(60'000));
        s.watch.reach(first_job, "load", 0.0);
        const std::string again = watcher.next();
        CHECK(summary(again, "attempt") == "state=1 state=2 progress");
        CHECK(summary(again, "stage") == R"(state state progress="load")");
    }

    TEST_CASE("what the result says of the model is told before the end") {
        StreamSetting s;
        REQUIRE(s.add(new_job("A")) == Admission::queued);
        const Claim claim = s.store.claim(60'000).value();
        const char metrics[] = R"({"repairs": [{"code": "stitched"}],
                                   "warnings": [{"code": "unit_assumed"}, {"code": "no_fan"}]})";
        REQUIRE(s.store.finish(claim.lease, result_with(s.blobs, metrics)));
        const std::string all = Watcher(s, s.request("A")).next();
        CHECK(summary(all, "code") ==
              R"(state state state log="stitched" log="unit_assumed" log="no_fan" done)");
        CHECK(summary(all, "level") ==
              R"(state state state log="info" log="warning" log="warning" done)");
    }

    TEST_CASE("a job that is deleted and a service that ends are said, and end the stream") {
        StreamSetting s;
        for (const char* id : {"A", "B"}) REQUIRE(s.add(new_job(id)) == Admission::queued);
        Watcher a(s, s.request("A"));
        (void)a.next();
        REQUIRE(s.store.remove("", "A"));
        s.watch.changed(first_job);
        CHECK(summary(a.next()) == "deleted");
        CHECK_FALSE(a.goes_on);
        a.response = {};
        Watcher b(s, s.request("B"));
        (void)b.next();
        s.watch.close(std::chrono::milliseconds(0));
        CHECK(summary(b.next()) == "shutdown");
        CHECK_FALSE(b.goes_on);
    }

    TEST_CASE("a client that is gone ends its stream and gives its place back") {
        StreamSetting s;
        REQUIRE(s.add(new_job("A")) == Admission::queued);
        {
            Watcher watcher(s, s.request("A"));
            CHECK(s.seats.free() == 0);
            CHECK(code_of(s, s.request("A")) == "streams_full");
            const auto gone = [](std::string_view) { return false; };
            CHECK_FALSE(watcher.response.stream(gone));
            (void)watcher.next();
            REQUIRE(s.store.claim(60'000));
            s.watch.changed(first_job);
            CHECK_FALSE(watcher.response.stream(gone));
        }
        CHECK(s.seats.free() == 1);
    }

    TEST_CASE("a key has as many seats as are left for the others") {
        SeatsByKey seats(8);
        const auto take_all = [&](const std::string& key) {
            int taken = 0;
            while (seats.enter(key)) ++taken;
            return taken;
        };
        CHECK(take_all("a") == 4);
        CHECK(take_all("b") == 2);
        CHECK(take_all("c") == 1);
        CHECK(take_all("d") == 1);
        CHECK(take_all("e") == 0);
        for (int i = 0; i < 4; ++i) seats.leave("a");
        CHECK(take_all("e") == 2);
        SeatsByKey open(3);
        int taken = 0;
        while (open.enter("")) ++taken;
        CHECK(taken == 3);
    }

    TEST_CASE("who may not, cannot or does not want to watch is told why") {
        StreamSetting s;
        REQUIRE(s.add(new_job("A", "key")) == Admission::queued);
        CHECK(code_of(s, s.request("A", "another key")) == "job_not_found");
        CHECK(code_of(s, s.request("B", "key")) == "job_not_found");
        http::Request request = s.request("A", "key");
        for (const auto& [accept, status] :
             {std::pair("application/json", 406), std::pair("text/event-stream", 200),
              std::pair("text/*;q=0.1", 200), std::pair("*/*", 200), std::pair("", 200)}) {
            CAPTURE(accept);
            request.headers["accept"] = accept;
            CHECK(status_of(s, request) == status);
        }
    }
}

}  // namespace lastflat::server
