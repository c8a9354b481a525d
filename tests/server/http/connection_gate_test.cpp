// The gate by itself: what it hands on, what it answers, when it lets go. The server behind it is
// tested in server_test.cpp and server_load_test.cpp.
#include "server/http/connection_gate.h"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/socket.h>

#include <deque>

#include "tests/helpers/eventually.h"
#include "tests/server/http/raw_client.h"

using namespace lastflat::http;
using lastflat::test::eventually;
using std::chrono::milliseconds;

namespace {

/// A gate whose heads are taken by the test, or answered with "said", and its clients.
class GateSetting {
public:
    explicit GateSetting(const ServerLimits& limits = {}, bool answers = false)
        : gate_(
              limits,
              [this, answers](Socket& socket, std::string& bytes, std::size_t head_size) {
                  const std::lock_guard lock(mutex_);
                  heads_.push_back(bytes.substr(0, head_size) + "|" + bytes.substr(head_size));
                  if (answers) return std::optional<std::string>("said");
                  taken_.push_back(std::move(socket));
                  bytes.clear();
                  return std::optional<std::string>();
              },
              [](const RefusedHead& refusal) {
                  return std::to_string(refusal.problem().status) + " " +
                         std::string(refusal.problem().code.word()) +
                         (refusal.is_without_body() ? " without body" : "");
              }) {}

    /// A client whose other end is at the gate.
    RawClient connected(const std::string& read_before = "") {
        auto [client, server] = socket_pair();
        gate_.admit(std::move(server), read_before);
        return RawClient(std::move(client));
    }
    RawClient lingering() {
        auto [client, server] = socket_pair();
        gate_.linger(std::move(server));
        return RawClient(std::move(client));
    }
    ConnectionGate& gate() { return gate_; }

    /// "head|what came behind it" of the next connection that was handed on.
    std::string next_head() {
        std::string head;
        (void)eventually([&] {
            const std::lock_guard lock(mutex_);
            if (heads_.empty()) return false;
            head = heads_.front();
            heads_.pop_front();
            return true;
        });
        return head;
    }
    std::size_t untold_heads() {
        const std::lock_guard lock(mutex_);
        return heads_.size();
    }

private:
    static std::pair<Socket, Socket> socket_pair() {
        int ends[2];
        REQUIRE(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) == 0);
        REQUIRE(::fcntl(ends[1], F_SETFL, O_NONBLOCK) == 0);
        return {Socket(ends[0]), Socket(ends[1])};
    }

    std::mutex mutex_;
    std::deque<std::string> heads_;
    std::vector<Socket> taken_;
    ConnectionGate gate_;  // last: its thread uses the others
};

const std::string head = "GET / HTTP/1.1\r\nHost: a\r\n\r\n";

ServerLimits with_head_time(int ms) {
    ServerLimits limits;
    limits.head_time = milliseconds(ms);
    return limits;
}

}  // namespace

TEST_SUITE("server/http/connection_gate") {
    TEST_CASE("a head is handed on once it is whole, with what came behind it") {
        GateSetting s;
        for (const std::size_t step : {head.size() + 4, std::size_t(7), std::size_t(1)}) {
            CAPTURE(step);
            RawClient client = s.connected();
            const std::string bytes = head + "body";
            for (std::size_t at = 0; at < head.size(); at += step)
                client.send(bytes.substr(at, step));
            const std::string told = s.next_head();
            CHECK(told.substr(0, head.size() + 1) == head + "|");
            CHECK(std::string("body").starts_with(told.substr(head.size() + 1)));
            CHECK(s.untold_heads() == 0);
        }
    }

    TEST_CASE("what was read before is looked at without waiting for more") {
        GateSetting s;
        const RawClient whole = s.connected(head + "rest");
        CHECK(s.next_head() == head + "|rest");
        RawClient half = s.connected(head.substr(0, head.size() - 2));
        half.send("\r\n");
        CHECK(s.next_head() == head + "|");
    }

    TEST_CASE("an answer at the gate is sent, and the client may still be sending") {
        GateSetting s({}, true);
        RawClient client = s.connected();
        client.send(head);
        CHECK(client.receive_until("said") == "said");
        CHECK(client.send(std::string(10'000, 'x')));  // would fail on a closed socket
        CHECK(client.send("x"));
        CHECK(client.receive() == "");  // its side was shut down
        CHECK(client.was_closed());
    }

    TEST_CASE("a head beyond its limit is refused, a request line beyond it by a code of its own") {
        ServerLimits limits;
        limits.head_bytes = 100;
        GateSetting s(limits);
        const std::pair<std::string, const char*> table[] = {
            {"GET /" + std::string(100, 'a'), "414 target_too_long"},
            {"HEAD /" + std::string(100, 'a'), "414 target_too_long without body"},
            {"GET / HTTP/1.1\r\nX: " + std::string(100, 'a'), "431 head_too_large"},
            {"HEAD / HTTP/1.1\r\nX: " + std::string(100, 'a') + "\r\n\r\n",
             "431 head_too_large without body"},
        };
        for (const auto& [bytes, answer] : table) {
            CAPTURE(bytes);
            RawClient client = s.connected();
            client.send(bytes);
            CHECK(client.receive() == answer);
        }
        std::string longest = "GET / HTTP/1.1\r\nX: ";
        longest += std::string(100 - longest.size() - 4, 'a') + "\r\n\r\n";
        s.connected().send(longest + std::string(500, 'b'));  // the body does not count
        CHECK(s.next_head().starts_with(longest + "|"));
    }

    TEST_CASE(
        "who is silent is closed without a word, who has begun is told that it was too slow") {
        GateSetting s(with_head_time(100));
        RawClient silent = s.connected(), slow = s.connected();
        slow.send("GET / HTT");
        CHECK(slow.receive() == "408 head_too_slow");
        CHECK(silent.receive() == "");
        CHECK(silent.was_closed());
    }

    TEST_CASE("of those who wait the oldest make room, and no more than must") {
        ServerLimits limits;
        limits.waiting_connections = 2;
        GateSetting s(limits);
        std::vector<RawClient> clients;
        for (int i = 0; i < 3; ++i) clients.push_back(s.connected());
        CHECK(clients[0].receive() == "");
        CHECK(clients[0].was_closed());
        for (const std::size_t i : {2u, 1u}) {
            clients[i].send(head);
            CHECK(s.next_head() == head + "|");
        }
    }

    TEST_CASE("heads that are not whole can be dropped; what comes whole still is handed on") {
        GateSetting s;
        RawClient unfinished = s.connected();
        unfinished.send("GET /");
        s.gate().drop_unfinished();
        CHECK(unfinished.receive() == "");
        CHECK(unfinished.was_closed());
        const RawClient whole = s.connected(head);
        CHECK(s.next_head() == head + "|");
        RawClient late = s.connected("GET /");
        CHECK(late.receive() == "");
        CHECK(late.was_closed());
    }

    TEST_CASE("a client that never hangs up is let go, so the end is bounded") {
        GateSetting s;
        const auto begun = Clock::now();
        RawClient stays = s.lingering(), hangs_up = s.lingering();
        stays.send(std::string(100'000, 'x'));
        hangs_up.finish_sending();
        CHECK(hangs_up.receive() == "");
        CHECK(hangs_up.was_closed());
        s.gate().finish();
        CHECK(Clock::now() - begun >= milliseconds(900));  // it had its time to read the answer
        CHECK(Clock::now() - begun < lastflat::test::long_enough);
        CHECK_FALSE(stays.send("x"));
    }
}
