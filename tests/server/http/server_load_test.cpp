// What many, slow or broken clients do to the others; starting and stopping.
#include <doctest/doctest.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include "server/http/connection_gate.h"
#include "tests/helpers/eventually.h"
#include "tests/server/http/running_server.h"

using namespace lastflat::http;
using lastflat::test::eventually;
using std::chrono::milliseconds;

namespace {

/// Descriptors of this process that listen on the port, in rising order.
std::vector<int> listeners(int port) {
    std::vector<int> found;
    for (int fd = 3; fd < 4096; ++fd) {
        int accepting = 0;
        socklen_t size = sizeof accepting;
        sockaddr_in address{};
        socklen_t address_size = sizeof address;
        if (::getsockopt(fd, SOL_SOCKET, SO_ACCEPTCONN, &accepting, &size) == 0 && accepting &&
            ::getsockname(fd, reinterpret_cast<sockaddr*>(&address), &address_size) == 0 &&
            ntohs(address.sin_port) == port) {
            found.push_back(fd);
        }
    }
    return found;
}

milliseconds since(Clock::time_point start) {
    return std::chrono::duration_cast<milliseconds>(Clock::now() - start);
}

/// A header that names the client.
std::string from(const std::string& who) {
    return "X-Who: " + who + "\r\n";
}

std::string healthz(int port) {
    return ask(port, get("/healthz"));
}

}  // namespace

TEST_SUITE("server/http/server under load") {
    TEST_CASE("those who wait in the waiting room take no connection from others") {
        ServerLimits limits;
        limits.connections = 1;
        limits.waiting_requests = 2;
        RunningServer server(limits);
        RawClient first(server.port()), second(server.port());
        first.send(get("/seat"));
        second.send(get("/seat"));
        REQUIRE(server.turnstile.wait_for(2));
        CHECK(body_of(ask(server.port(), get("/seat"))) == "no seat");
        CHECK(status_of(ask(server.port(), get("/echo"))) == 200);
        server.turnstile.open();
        CHECK(body_of(first.receive()) == "sat");
        CHECK(body_of(second.receive()) == "sat");
    }

    TEST_CASE("health is answered while everything else is taken") {
        ServerLimits limits;
        limits.connections = 3;
        limits.queued_requests = 2;
        RunningServer server(limits);
        std::vector<std::unique_ptr<RawClient>> clients;
        const auto connect = [&](const std::string& bytes) {
            clients.push_back(std::make_unique<RawClient>(server.port()));
            clients.back()->send(bytes);
        };
        for (int i = 0; i < 200; ++i) connect("");
        connect("GET /echo HTTP/1.1\r\nHos");
        for (const char* who : {"a", "b", "c"}) connect(get("/wait", from(who)));
        REQUIRE(server.turnstile.wait_for(3));
        for (const char* who : {"a", "b"}) connect(get("/wait", from(who)));

        const auto start = Clock::now();
        CHECK(body_of(healthz(server.port())) == "ok");
        CHECK(since(start) < milliseconds(500));

        const std::string refused = ask(server.port(), get("/echo"));
        CHECK(status_of(refused) == 503);
        CHECK(refused.find("Retry-After: ") != std::string::npos);
        CHECK(server.turnstile.waiting() == 3);

        server.turnstile.open();
        for (std::size_t i = 201; i < clients.size(); ++i) {
            CHECK(body_of(clients[i]->receive()) == "waited");
        }
    }

    TEST_CASE("one client has half of the places, however much it asks, and others are served") {
        ServerLimits limits;
        limits.connections = 4;
        limits.queued_requests = 8;
        RunningServer server(limits);
        std::atomic<int> refused{0}, served{0};
        std::vector<std::thread> clients;
        const auto ask_as = [&](const char* who) {
            clients.emplace_back([&, who] {
                const std::string body = body_of(ask(server.port(), get("/wait", from(who))));
                if (body == "client_busy") ++refused;
                if (body == "waited") ++served;
            });
        };
        for (int i = 0; i < 7; ++i) ask_as("a");  // two are served, four wait
        CHECK(server.turnstile.wait_for(2));
        CHECK(eventually([&] { return refused == 1; }));
        CHECK(server.turnstile.waiting() == 2);
        CHECK(status_of(ask(server.port(), get("/echo", from("b")))) == 200);
        ask_as("b");
        CHECK(server.turnstile.wait_for(3));
        CHECK(status_of(ask(server.port(), get("/echo", from("c")))) == 200);
        CHECK(status_of(ask(server.port(), get("/echo"))) == 200);  // by its address
        server.turnstile.open();
        for (std::thread& client : clients) client.join();
        CHECK(served == 7);
        CHECK(refused == 1);
    }

    TEST_CASE("one address without a name has half of the places") {
        ServerLimits limits;
        limits.connections = 2;
        limits.trusted_proxies = {"127.0.0.1"};
        RunningServer server(limits);
        RawClient first(server.port()), second(server.port());
        first.send(get("/wait", "X-Forwarded-For: 198.51.100.7\r\n"));
        REQUIRE(server.turnstile.wait_for(1));
        second.send(get("/wait", "X-Forwarded-For: 203.0.113.9, 198.51.100.7\r\n"));
        const std::string other =
            ask(server.port(), get("/echo", "X-Forwarded-For: 198.51.100.8\r\n"));
        CHECK(body_of(other) == "GET /echo 198.51.100.8");
        CHECK(server.turnstile.waiting() == 1);
        server.turnstile.open();
        CHECK(body_of(first.receive()) == "waited");
        CHECK(body_of(second.receive()) == "waited");
    }

    TEST_CASE("a handler learns that its client has hung up") {
        RunningServer server;
        {
            RawClient client(server.port());
            client.send(get("/until-gone"));
            REQUIRE(server.turnstile.wait_for(1));
        }
        CHECK(server.turnstile.wait_for(2));
    }

    TEST_CASE("the connection that has waited longest makes room") {
        ServerLimits limits;
        limits.waiting_connections = 10;
        RunningServer server(limits);
        std::vector<std::unique_ptr<RawClient>> clients;
        for (int i = 0; i < 40; ++i) {
            clients.push_back(std::make_unique<RawClient>(server.port()));
        }
        CHECK(body_of(healthz(server.port())) == "ok");
        CHECK(clients.front()->receive() == "");
        CHECK(clients.front()->was_closed());
        clients.back()->send(get("/echo"));
        CHECK(status_of(clients.back()->receive()) == 200);
    }

    TEST_CASE("a head must be complete in time") {
        ServerLimits limits;
        limits.head_time = milliseconds(150);
        RunningServer server(limits);
        RawClient silent(server.port());
        RawClient slow(server.port());
        slow.send("GET /echo HTTP/1.1\r\n");
        const std::string answer = slow.receive();
        CHECK(status_of(answer) == 408);
        CHECK(body_of(answer) == "head_too_slow");
        CHECK(silent.receive() == "");
        CHECK(silent.was_closed());
    }

    TEST_CASE("a body must be complete in time") {
        ServerLimits limits;
        limits.body_time = milliseconds(150);
        RunningServer server(limits);
        const auto start = Clock::now();
        CHECK(body_of(ask(server.port(), post("Content-Length: 5\r\n", "hell"))) ==
              "body_too_slow");
        CHECK(body_of(ask(server.port(), post("Transfer-Encoding: chunked\r\n", "5\r\nhell"))) ==
              "body_too_slow");
        CHECK(since(start) < milliseconds(5000));
    }

    TEST_CASE("a body must come at a minimum rate, whatever came before") {
        ServerLimits limits;
        limits.body_time = milliseconds(60'000);
        limits.rate_window = milliseconds(300);
        limits.least_bytes_per_second = 1000;
        RunningServer server(limits);
        for (const std::size_t burst : {20u, 2'000'000u}) {
            const auto start = Clock::now();
            CHECK(status_of(ask(server.port(), post("Content-Length: 3000000\r\n",
                                                    std::string(burst, 'x')))) == 408);
            CHECK(since(start) >= milliseconds(290));
            CHECK(since(start) < milliseconds(5000));
        }
    }

    TEST_CASE("an answer must be read at a minimum rate, whatever was read before") {
        ServerLimits limits;
        limits.write_time = milliseconds(60'000);
        limits.rate_window = milliseconds(300);
        limits.least_bytes_per_second = 100'000;
        limits.connections = 1;
        RunningServer server(limits);
        RawClient lazy(server.port());
        lazy.send(get("/huge"));
        REQUIRE(lazy.receive_until("200 OK") != "");
        const auto start = Clock::now();
        CHECK(status_of(ask(server.port(), get("/echo"))) == 200);
        CHECK(since(start) < milliseconds(5000));
    }

    TEST_CASE("an answer must be taken in time") {
        ServerLimits limits;
        limits.write_time = milliseconds(100);
        limits.connections = 1;
        RunningServer server(limits);
        for (int i = 0; i < 3; ++i) {
            RawClient lazy(server.port());
            lazy.send(get("/huge"));
            REQUIRE(lazy.receive_until("200 OK") != "");
            // The one thread is free again, or this would find nobody.
            CHECK(status_of(ask(server.port(), get("/echo"))) == 200);
        }
    }

    TEST_CASE(
        "a client that reads steadily is not too slow, however much the kernel holds for it") {
        ServerLimits limits;
        limits.rate_window = milliseconds(300);
        limits.least_bytes_per_second = 300'000;
        RunningServer server(limits);
        RawClient steady(server.port());
        steady.send(get("/huge"));
        std::size_t received = 0;
        while (received < 9'000'000) {  // 3 MB a second
            const std::size_t got = steady.receive_some(60'000);
            REQUIRE(got > 0);
            received += got;
            std::this_thread::sleep_for(milliseconds(20));
        }
    }

    TEST_CASE("those who are refused and do not read make no thread wait") {
        ServerLimits limits;
        limits.connections = 2;
        limits.waiting_requests = 0;
        RunningServer server(limits);
        std::string many;
        for (int i = 0; i < 40'000; ++i)
            many += "GET /echo HTTP/1.1\r\nHost: a\r\nAuthorization: no\r\n\r\n";
        std::vector<std::unique_ptr<RawClient>> clients;
        std::vector<std::thread> senders;
        for (int i = 0; i < 5; ++i) {
            clients.push_back(std::make_unique<RawClient>(server.port()));
            senders.emplace_back([&, client = clients.back().get()] { client->send(many); });
        }
        for (std::thread& sender : senders)
            sender.join();  // the server has closed them, or read all
        const auto start = Clock::now();
        CHECK(status_of(ask(server.port(), get("/echo"))) == 200);
        CHECK(since(start) < milliseconds(5000));
    }

    TEST_CASE("bodies of all requests together are bounded") {
        ServerLimits limits;
        limits.all_bodies_bytes = 1000;
        RunningServer server(limits);
        const std::string answer =
            ask(server.port(), post("Content-Length: 1001\r\n", std::string(1001, 'x')));
        CHECK(status_of(answer) == 503);
        CHECK(answer.find("Retry-After: ") != std::string::npos);
        // What the first one took was given back.
        for (int i = 0; i < 3; ++i) {
            CHECK(status_of(ask(server.port(),
                                post("Content-Length: 900\r\n", std::string(900, 'x')))) == 200);
        }
    }

    TEST_CASE("stopping finishes what runs and what is queued, and nothing else") {
        ServerLimits limits;
        limits.connections = 1;
        RunningServer server(limits);
        RawClient running(server.port());
        running.send(get("/wait"));
        REQUIRE(server.turnstile.wait_for(1));
        RawClient queued(server.port());
        queued.send(get("/echo"));
        RawClient unfinished(server.port());
        unfinished.send("GET /echo HTTP/1.1\r\n");
        REQUIRE(body_of(healthz(server.port())) == "ok");  // so the gate has seen the ones before

        server.server().stop();
        server.server().stop();
        CHECK(unfinished.receive() == "");
        CHECK(unfinished.was_closed());
        CHECK_THROWS(RawClient(server.port()));
        server.turnstile.open();
        CHECK(body_of(running.receive()) == "waited");
        CHECK(status_of(queued.receive()) == 200);
        server.join();
        CHECK(server.run_error() == "");
    }

    TEST_CASE("stopping does not wait for a body for long") {
        ServerLimits limits;
        limits.stop_time = milliseconds(100);
        RunningServer server(limits);
        RawClient client(server.port());
        client.send(post("Content-Length: 5\r\nExpect: 100-continue\r\n", ""));
        REQUIRE(client.receive_until("\r\n\r\n") != "");
        const auto start = Clock::now();
        server.server().stop();
        CHECK(status_of(client.receive()) == 408);
        server.join();
        CHECK(since(start) < milliseconds(5000));
    }

    TEST_CASE("the kernel queues hundreds of connections that are not yet accepted") {
        Server server({}, {}, {test_problem});
        const int port = server.bind("127.0.0.1", 0);
        tcp_info info{};
        socklen_t size = sizeof info;
        REQUIRE(::getsockopt(listeners(port).at(0), IPPROTO_TCP, TCP_INFO, &info, &size) == 0);
        CHECK(info.tcpi_sacked >= 128);  // of a listening socket: its backlog
    }

    TEST_CASE("a server stopped before it runs does not run") {
        for (const bool bound_first : {true, false}) {
            Server server({{"GET", "/", [](const Request&) { return Response{}; }}}, {},
                          {test_problem});
            if (!bound_first) server.stop();
            server.bind("127.0.0.1", 0);
            server.stop();
            server.run();
        }
    }

    TEST_CASE("a port has one server") {
        RunningServer first;
        for (const char* host : {"127.0.0.1", "localhost"}) {
            Server second({}, {}, {test_problem});
            CHECK_THROWS_AS(second.bind(host, first.port()), std::runtime_error);
        }
        Server nowhere({}, {}, {test_problem});
        CHECK_THROWS_AS(nowhere.bind("203.0.113.1", 0), std::runtime_error);
        CHECK_THROWS(nowhere.run());
    }

    TEST_CASE("every spelling of an address can be bound") {
        for (const char* host : {"127.0.0.1", "0.0.0.0", "localhost", "::1", "[::1]"}) {
            CAPTURE(host);
            Server server({}, {}, {test_problem});
            CHECK(server.bind(host, 0) > 0);
        }
    }

    TEST_CASE("an error of accept does not end the service") {
        RunningServer server;
        REQUIRE(healthz(server.port()) != "");
        const std::vector<int> found = listeners(server.port());
        REQUIRE(found.size() == 2);
        // The library's descriptor now names a socket that cannot accept: it gives up on it.
        const Socket other(::socket(AF_INET, SOCK_STREAM, 0));
        REQUIRE(::dup2(other.fd(), found[0]) == found[0]);
        for (int i = 0; i < 3; ++i) CHECK(body_of(healthz(server.port())) == "ok");
        CHECK(server.run_error() == "");
    }

    TEST_CASE("a listening socket that stays broken ends the service with an error") {
        RunningServer server;
        REQUIRE(healthz(server.port()) != "");
        REQUIRE(::shutdown(listeners(server.port()).at(0), SHUT_RDWR) == 0);
        server.join();
        CHECK(server.run_error().find("accept") != std::string::npos);
    }
}
