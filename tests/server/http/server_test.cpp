// What a client sees: answers, bodies, refusals.
#include <doctest/doctest.h>

#include "tests/server/http/running_server.h"

using namespace lastflat::http;

namespace {

ServerLimits small_limits() {
    ServerLimits limits;
    limits.body_bytes = 1000;
    limits.head_bytes = 2000;
    limits.connections = 4;
    return limits;
}

struct RequestRow {
    std::string request;
    int status;
    std::string body;
};

}  // namespace

TEST_SUITE("server/http/server") {
    TEST_CASE("requests reach their handlers whole") {
        RunningServer server(small_limits());
        const std::string chunks = "5\r\nhello\r\n1;x=y\r\n!\r\n0\r\n\r\n";
        const std::string form =
            "--B\r\nContent-Disposition: form-data; name=\"m\"\r\n\r\nbytes\r\n--B--\r\n";
        const std::string length = std::to_string(form.size());
        const RequestRow rows[] = {
            {get("/echo?a=b"), 200, "GET /echo 127.0.0.1"},
            {get("/echo?a=b&b=a"), 400, "parameter_unknown"},
            {get("/large?a=b"), 400, "parameter_unknown"},
            {"OPTIONS /large?a=b HTTP/1.1\r\nHost: a\r\nConnection: close\r\n\r\n", 204, ""},
            {get("/echo", "REMOTE_ADDR: 9.9.9.9\r\n"), 200, "GET /echo 127.0.0.1"},
            {"GET /echo HTTP/1.0\r\n\r\n", 200, "GET /echo 127.0.0.1"},
            {post("Content-Length: 0\r\n", ""), 200, "POST /echo 127.0.0.1"},
            {post("", ""), 200, "POST /echo 127.0.0.1"},
            {post("Content-Length: 5\r\nContent-Type: Model/OBJ;x=y\r\n", "hello"), 200,
             "POST /echo 127.0.0.1\n|model/obj|hello"},
            {post("Content-Length: 5\r\nContent-Type: application/x-www-form-urlencoded\r\n",
                  "a%20b"),
             200, "POST /echo 127.0.0.1\n|application/x-www-form-urlencoded|a%20b"},
            {post("Transfer-Encoding: chunked\r\n", chunks), 200, "POST /echo 127.0.0.1\n||hello!"},
            {post("Content-Type: multipart/form-data; boundary=\"B\"; charset=utf-8\r\n"
                  "Content-Length: " +
                      length + "\r\n",
                  form),
             200, "POST /echo 127.0.0.1\nm||bytes"},
        };
        for (const RequestRow& row : rows) {
            CAPTURE(row.request);
            const std::string answer = ask(server.port(), row.request);
            CHECK(status_of(answer) == row.status);
            CHECK(body_of(answer) == row.body);
            CHECK(count_of(answer, "Connection: close\r\n") == 1);
            CHECK(count_of(answer, "X-Content-Type-Options: nosniff\r\n") == 1);
            CHECK(count_of(answer, "Date: ") == 1);
        }
    }

    TEST_CASE("every method reaches its handler, with and without a body, by any vetted path") {
        RunningServer server(small_limits());
        const std::string path = "/v1/..//01ARZ3NDEKTSV4RRFFQ69G5FAV:any.";
        const std::string head =
            " " + path + "?a=%3F?b HTTP/1.1\r\nHost: a\r\nConnection: close\r\n";
        for (const std::string method : {"GET", "POST", "PUT", "PATCH", "DELETE", "OPTIONS"}) {
            CAPTURE(method);
            const std::string answer = ask(server.port(), method + head + "\r\n");
            CHECK(status_of(answer) == 200);
            CHECK(body_of(answer) == method + " " + path + " 127.0.0.1");
        }
        const std::string headed = ask(server.port(), "HEAD" + head + "\r\n");
        CHECK(status_of(headed) == 200);
        CHECK(body_of(headed) == "");
        for (const std::string method : {"POST", "PUT", "PATCH"}) {
            for (const std::string body :
                 {"Content-Length: 2\r\n\r\nab",
                  "Transfer-Encoding: chunked\r\n\r\n2\r\nab\r\n0\r\n\r\n"}) {
                CAPTURE(method);
                CAPTURE(body);
                CHECK(body_of(ask(server.port(), method + head + body)) ==
                      method + " " + path + " 127.0.0.1\n||ab");
            }
        }
        for (const std::string method : {"TRACE", "CONNECT", "PRI", "BREW"}) {
            CAPTURE(method);
            CHECK(status_of(ask(server.port(), method + head + "\r\n")) == 501);
        }
        for (const std::string odd : {"*", "/v1/../echo", "/%65cho", "/echo%00", "/echo/", "//echo",
                                      "/echo%3Fa", "/echo;a", "/echo%u0041"}) {
            CAPTURE(odd);
            const int status = status_of(ask(server.port(), get(odd)));
            CHECK((status == 400 || status == 404));
        }
    }

    TEST_CASE("requests that break a rule are refused with its code") {
        RunningServer server(small_limits());
        const std::string form_type =
            "Content-Type: multipart/form-data; boundary=B\r\nContent-Length: 80\r\n";
        const std::string cut_form =
            "--B\r\nContent-Disposition: form-data; name=\"m\"\r\n\r\n" + std::string(31, 'x');
        REQUIRE(cut_form.size() == 80);
        const RequestRow rows[] = {
            {get("/nowhere"), 404, "not_found"},
            {"DELETE /echo HTTP/1.1\r\nHost: a\r\n\r\n", 405, "method_not_allowed"},
            {get("/echo", "Content-Length: 30\r\n") + "GET /echo HTTP/1.1\r\nHost: a\r\n\r\n", 400,
             "body_not_allowed"},
            {post("Content-Length: 5\r\nTransfer-Encoding: chunked\r\n", "0\r\n\r\n"), 400,
             "ambiguous_length"},
            {post("Content-Length: 1001\r\n", ""), 413, "body_too_large"},
            {post("Transfer-Encoding: chunked\r\n", "3e9\r\n"), 413, "body_too_large"},
            {post("Transfer-Encoding: chunked\r\n",
                  "3e8\r\n" + std::string(1000, 'x') + "\r\n1\r\nx\r\n0\r\n\r\n"),
             413, "body_too_large"},
            {post("Transfer-Encoding: chunked\r\n", "5\r\nhello0\r\n\r\n"), 400, "bad_chunks"},
            {post("Transfer-Encoding: chunked\r\n", "-2\r\n"), 400, "bad_chunks"},
            {post("Transfer-Encoding: chunked\r\n", "0\r\nX: y\r\n\r\n"), 400, "bad_chunks"},
            {post(form_type, cut_form), 400, "bad_multipart"},
            {get("/" + std::string(2000, 'a')), 414, "target_too_long"},
            {get("/echo", "X: " + std::string(2000, 'a') + "\r\n"), 431, "head_too_large"},
            {"\x16\x03\x01\x02", 400, "bad_line_end"},
            {"GET /echo HTTP/1.1\nHost: a\n\n", 400, "bad_line_end"},
        };
        for (const RequestRow& row : rows) {
            CAPTURE(row.request);
            const std::string answer = ask(server.port(), row.request);
            CHECK(status_of(answer) == row.status);
            CHECK(body_of(answer) == row.body);
            CHECK(count_of(answer, "HTTP/1.1 ") == 1);
            CHECK(count_of(answer, "X-Content-Type-Options: nosniff\r\n") == 1);
        }
        CHECK(ask(server.port(), "PUT /echo HTTP/1.1\r\nHost: a\r\n\r\n")
                  .find("Allow: GET, HEAD, POST, OPTIONS\r\n") != std::string::npos);
    }

    TEST_CASE("a body that ends early is refused") {
        RunningServer server(small_limits());
        for (const std::string& request :
             {post("Content-Length: 10\r\n", "hello"),
              post("Transfer-Encoding: chunked\r\n", "5\r\nhello\r\n"),
              post("Transfer-Encoding: chunked\r\n", "5\r\nhello\r\n0\r\n")}) {
            CAPTURE(request);
            RawClient client(server.port());
            client.send(request);
            client.finish_sending();
            const std::string answer = client.receive();
            CHECK(status_of(answer) == 400);
            CHECK(body_of(answer) == "body_cut_off");
        }
    }

    TEST_CASE("what follows a request that asks to close is not answered") {
        RunningServer server;
        CHECK(count_of(ask(server.port(), get("/echo") + get("/echo") + get("/echo")),
                       "HTTP/1.1 ") == 1);  // each asked to close after it
        CHECK(count_of(ask(server.port(),
                           get_and_stay("/echo") + get_and_stay("/healthz") + get("/echo")),
                       "HTTP/1.1 200") == 3);
        CHECK(count_of(ask(server.port(), post("Content-Length: 2\r\n", "ab" + get("/echo"))),
                       "HTTP/1.1 ") == 1);
    }

    TEST_CASE("the body is asked for only when it is wanted") {
        RunningServer server(small_limits());
        RawClient client(server.port());
        client.send(post("Content-Length: 5\r\nExpect: 100-continue\r\n", ""));
        CHECK(client.receive_until("\r\n\r\n") == "HTTP/1.1 100 Continue\r\n\r\n");
        client.send("hello");
        CHECK(body_of(client.receive()) == "POST /echo 127.0.0.1\n||hello");

        const std::string refused =
            ask(server.port(), post("Content-Length: 5000\r\nExpect: 100-continue\r\n", ""));
        CHECK(status_of(refused) == 413);
    }

    TEST_CASE("a client that is still sending sees why it was refused") {
        RunningServer server(small_limits());
        RawClient client(server.port());
        client.send(post("Content-Length: 20000000\r\n", ""));
        client.send(std::string(200'000, 'x'));
        CHECK(status_of(client.receive()) == 413);
        // Still open on the server's side: a reset would fail the second one.
        CHECK(client.send("x"));
        CHECK(client.send("x"));
    }

    TEST_CASE("a connection stays for further requests, unless a body was left unread") {
        RunningServer server;
        RawClient client(server.port());
        for (int i = 0; i < 3; ++i) {
            client.send(get_and_stay("/echo"));
            CHECK(client.receive_until("GET /echo 127.0.0.1").find("Connection: close") ==
                  std::string::npos);
            client.send("POST /echo HTTP/1.1\r\nHost: a\r\nContent-Length: 5\r\n\r\nhello");
            CHECK(client.receive_until("hello").find("200 OK") != std::string::npos);
        }
        client.send(
            "POST /echo HTTP/1.1\r\nHost: a\r\nAuthorization: no\r\nContent-Length: 99\r\n\r\n" +
            get("/echo"));
        const std::string refused = client.receive();
        CHECK(status_of(refused) == 401);
        CHECK(refused.find("Connection: close") != std::string::npos);
        CHECK(refused.find("X-Admitted: yes") != std::string::npos);
        CHECK(count_of(refused, "HTTP/1.1 ") == 1);
    }

    TEST_CASE("who is not admitted is not asked for the body") {
        RunningServer server;
        const std::string answer =
            ask(server.port(),
                post("Authorization: no\r\nExpect: 100-continue\r\nContent-Length: 5\r\n", ""));
        CHECK(status_of(answer) == 401);
    }

    TEST_CASE("a stream arrives in chunks, and the connection stays") {
        RunningServer server;
        const std::string answer = ask(server.port(), get_and_stay("/stream") + get("/echo"));
        CHECK(answer.find("Transfer-Encoding: chunked") != std::string::npos);
        CHECK(answer.find("7\r\nevent 3\r\n7\r\nevent 2\r\n7\r\nevent 1\r\n0\r\n") !=
              std::string::npos);
        CHECK(count_of(answer, "HTTP/1.1 200") == 2);
        CHECK(status_of(ask(server.port(), "GET /stream HTTP/1.0\r\nHost: a\r\n\r\n")) == 505);
    }

    TEST_CASE("requests carry an id, the client's own if it is clean") {
        RunningServer server;
        CHECK(ask(server.port(), get("/echo", "X-Request-Id: order-7\r\n"))
                  .find("X-Request-Id: order-7\r\n") != std::string::npos);
        const std::string other = ask(server.port(), get("/echo", "X-Request-Id: a b\r\n"));
        CHECK(other.find("X-Request-Id: ") != std::string::npos);
        CHECK(other.find("X-Request-Id: a b") == std::string::npos);
    }

    TEST_CASE("HEAD is GET without the body, also when refused") {
        RunningServer server;
        const std::string large =
            ask(server.port(), "HEAD /large HTTP/1.1\r\nHost: a\r\nConnection: close\r\n\r\n");
        CHECK(status_of(large) == 200);
        CHECK(large.find("Content-Length: 3000000\r\n") != std::string::npos);
        CHECK(large.find("Accept-Ranges") == std::string::npos);
        CHECK(body_of(large) == "");
        for (const char* path : {"/nowhere", "/throw"}) {
            const std::string refused =
                ask(server.port(), std::string("HEAD ") + path +
                                       " HTTP/1.1\r\nHost: a\r\nConnection: close\r\n\r\n");
            CHECK(status_of(refused) >= 400);
            CHECK(body_of(refused) == "");
        }
    }

    TEST_CASE("a web page may read why its request was refused") {
        RunningServer server;
        const std::string refused =
            ask(server.port(),
                "POST /echo HTTP/1.1\r\nHost: a\r\nOrigin: https://studio.example\r\n"
                "Content-Length: 99999999999\r\n\r\n");
        CHECK(status_of(refused) == 413);
        CHECK(refused.find("X-Origin: https://studio.example\r\n") != std::string::npos);
    }

    TEST_CASE("OPTIONS and 204 have neither body nor length") {
        RunningServer server;
        const std::string options = ask(server.port(), "OPTIONS /echo HTTP/1.1\r\nHost: a\r\n\r\n");
        CHECK(status_of(options) == 204);
        CHECK(options.find("Allow: GET, HEAD, POST, OPTIONS\r\n") != std::string::npos);
        CHECK(options.find("Content-Length") == std::string::npos);
        CHECK(options.find("Content-Type:") == std::string::npos);
        const std::string empty = ask(server.port(), get("/empty"));
        CHECK(status_of(empty) == 204);
        CHECK(empty.find("Content-Length") == std::string::npos);
    }

    TEST_CASE("a large answer is whole, never partial, never compressed") {
        RunningServer server;
        for (const char* header : {"", "Range: bytes=0-9\r\n", "Range: bytes=0-9999999999\r\n",
                                   "Range: nonsense\r\n", "Accept-Encoding: br, gzip\r\n"}) {
            CAPTURE(header);
            const std::string answer = ask(server.port(), get("/large", header));
            CHECK(status_of(answer) == 200);
            CHECK(body_of(answer) == std::string(RunningServer::large_size, 'x'));
        }
    }

    TEST_CASE("a handler cannot break the framing of its answer") {
        RunningServer server;
        const std::string answer = ask(server.port(), get("/headers"));
        CHECK(answer.find("X-Good: yes\r\n") != std::string::npos);
        CHECK(answer.find("X-Injected") == std::string::npos);
        CHECK(answer.find("Bad name") == std::string::npos);
        CHECK(answer.find("Transfer-Encoding") == std::string::npos);
        CHECK(count_of(answer, "Content-Length: 1\r\n") == 1);
        CHECK(count_of(answer, "Content-Length") == 1);
        CHECK(count_of(answer, "Connection") == 1);
    }

    TEST_CASE("an exception becomes a 500 that says nothing of its cause") {
        RunningServer server;
        for (const char* path : {"/throw", "/throw-int"}) {
            const std::string answer = ask(server.port(), get(path));
            CHECK(status_of(answer) == 500);
            CHECK(body_of(answer) == "internal_error");
        }
        CHECK(server.failures() == "the secret;an exception of unknown type;");
        CHECK(status_of(ask(server.port(), get("/echo"))) == 200);
    }
}
