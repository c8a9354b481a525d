#include "server/http/head.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

using namespace lastflat::http;

namespace {

const std::string some_id = "01ARZ3NDEKTSV4RRFFQ69G5FAV";

RouteTable some_routes() {
    const Handler nothing = [](const Request&) { return Response{}; };
    return RouteTable({{"GET", "/healthz", nothing, false, true},
                       {"POST", "/v1/jobs", nothing, true},
                       {"GET", "/v1/jobs", nothing},
                       {"GET", "/v1/jobs/{id}", nothing},
                       {"DELETE", "/v1/jobs/{id}", nothing},
                       {"POST", "/v1/jobs/{id}/cancel", nothing}});
}

ServerLimits some_limits() {
    ServerLimits limits;
    limits.body_bytes = 1000;
    limits.head_lines = 8;
    return limits;
}

/// A GET with these lines after the Host line.
std::string get_with(const std::string& lines) {
    return "GET /v1/jobs HTTP/1.1\r\nHost: a\r\n" + lines + "\r\n";
}

std::string post_with(const std::string& lines) {
    return "POST /v1/jobs HTTP/1.1\r\nHost: a\r\n" + lines + "\r\n";
}

std::string get_of(const std::string& target) {
    return "GET " + target + " HTTP/1.1\r\nHost: a\r\n\r\n";
}

Head vetted(const std::string& raw) {
    static const RouteTable routes = some_routes();
    return vet_head(raw, routes, some_limits());
}

/// "status code" of the refusal, "served" without one.
std::string verdict(const std::string& raw) {
    try {
        (void)vetted(raw);
        return "served";
    } catch (const RefusedHead& refusal) {
        CHECK(std::string(refusal.what()).size() > 10);
        return std::to_string(refusal.problem().status) + " " +
               std::string(refusal.problem().code.word());
    }
}

struct HeadRow {
    std::string raw;
    std::string verdict;
};

void check_rows(const std::vector<HeadRow>& rows) {
    for (const HeadRow& row : rows) {
        CAPTURE(row.raw.substr(0, 300));
        CHECK(verdict(row.raw) == row.verdict);
    }
}

}  // namespace

TEST_SUITE("server/http/head") {
    TEST_CASE("a well-formed head is served") {
        check_rows({
            {get_with(""), "served"},
            {"GET /healthz HTTP/1.0\r\n\r\n", "served"},
            {"HEAD /healthz HTTP/1.1\r\nHost: a:80\r\n\r\n", "served"},
            {get_of("/v1/jobs/" + some_id + "?format=svg"), "served"},
            {get_with("Accept: a\r\nAccept: b\r\nX-Empty:\r\n"), "served"},
            {get_with("Range: bytes=0-5\r\n"), "served"},
            {get_with("Content-Length: 0\r\n"), "served"},
            {post_with(""), "served"},
            {post_with("Content-Length: 1000\r\n"), "served"},
            {post_with("content-length: 0005\r\n"), "served"},
            {post_with("Transfer-Encoding: chunked\r\n"), "served"},
            {post_with("Content-Length: 5\r\nContent-Encoding: identity\r\n"), "served"},
            {post_with("Content-Length: 5\r\nExpect: 100-continue\r\n"), "served"},
            {"DELETE /v1/jobs/" + some_id + " HTTP/1.1\r\nHost: a\r\nContent-Length: 0\r\n\r\n",
             "served"},
        });
    }

    TEST_CASE("a request line that is not exactly one is refused") {
        check_rows({
            {"\r\n", "400 bad_request_line"},
            {"GET\r\n\r\n", "400 bad_request_line"},
            {"GET /v1/jobs\r\nHost: a\r\n\r\n", "400 bad_request_line"},
            {"GET /v1/jobs HTTP/1.1 \r\nHost: a\r\n\r\n", "400 bad_request_line"},
            {"GET  /v1/jobs HTTP/1.1\r\nHost: a\r\n\r\n", "400 bad_target"},
            {"GET /v1 /jobs HTTP/1.1\r\nHost: a\r\n\r\n", "400 bad_target"},
            {"G(T /v1/jobs HTTP/1.1\r\nHost: a\r\n\r\n", "400 bad_request_line"},
            {"GET /v1/jobs http/1.1\r\nHost: a\r\n\r\n", "400 bad_request_line"},
            {"GET /v1/jobs HTTP/1.10\r\nHost: a\r\n\r\n", "400 bad_request_line"},
            {"GET /v1/jobs HTTP/2.0\r\nHost: a\r\n\r\n", "505 version_not_supported"},
            {"PRI * HTTP/2.0\r\n\r\n", "505 version_not_supported"},
            {"BREW /v1/jobs HTTP/1.1\r\nHost: a\r\n\r\n", "501 method_not_supported"},
            {"TRACE /v1/jobs HTTP/1.1\r\nHost: a\r\n\r\n", "501 method_not_supported"},
            {"get /v1/jobs HTTP/1.1\r\nHost: a\r\n\r\n", "501 method_not_supported"},
        });
    }

    TEST_CASE("a target is a clean path") {
        check_rows({
            {get_of("http://a/v1/jobs"), "400 bad_target"},
            {get_of("*"), "400 bad_target"},
            {get_of("v1/jobs"), "400 bad_target"},
            {get_of("/v1/jobs#x"), "400 bad_target"},
            {get_of("/v1/jobs%00"), "400 bad_target"},
            {get_of("/v1/jobs%0d%0aX:y"), "400 bad_target"},
            {get_of("/v1/jobs%7F"), "400 bad_target"},
            {get_of("/v1/jobs%1f"), "400 bad_target"},
            {get_of("/v1/jobs%"), "400 bad_target"},
            {get_of("/v1/jobs%4"), "400 bad_target"},
            {get_of("/v1/jobs%zz"), "400 bad_target"},
            {get_of("/v1/jobs%ff"), "400 bad_target"},
            {get_of("/v1/jobs%c0%af"), "400 bad_target"},
            {get_of("/v1/jobs\x01"), "400 bad_target"},
            {get_of("/v1/jobs\xc3\xa9"), "400 bad_target"},
            {get_of(std::string("/v1/jo\0bs", 9)), "400 bad_target"},
            {get_of("/v1/jobs?a=%00"), "400 bad_target"},
            {get_of("/v1/jobs?a=%ff"), "400 bad_target"},
            {get_of("/v1/jobs?a=1&a=2"), "400 repeated_parameter"},
            {get_of("/" + std::string(7999, 'a')), "404 not_found"},
            {get_of("/" + std::string(8000, 'a')), "414 target_too_long"},
        });
    }

    TEST_CASE("lines end with CR LF and are not folded") {
        check_rows({
            {"GET /v1/jobs HTTP/1.1\nHost: a\n\n", "400 bad_line_end"},
            {"GET /v1/jobs HTTP/1.1\r\nHost: a\n\r\n", "400 bad_line_end"},
            {"GET /v1/jobs HTTP/1.1\r\nHost: a\rX: y\r\n\r\n", "400 bad_line_end"},
            {"\x16\x03\x01\x02", "400 bad_line_end"},
            {get_with("X: a\r\n b\r\n"), "400 bad_header"},
            {get_with("X: a\r\n\tb: c\r\n"), "400 bad_header"},
        });
    }

    TEST_CASE("a header is a token, a colon and a value without control characters") {
        check_rows({
            {get_with("nothing\r\n"), "400 bad_header"},
            {get_with(": x\r\n"), "400 bad_header"},
            {get_with("X : y\r\n"), "400 bad_header"},
            {get_with("X(: y\r\n"), "400 bad_header"},
            {get_with(std::string("X: a\0b\r\n", 8)), "400 bad_header"},
            {get_with("X: a\x01\r\n"), "400 bad_header"},
            {get_with("X: a\x7f\r\n"), "400 bad_header"},
            {get_with("X: a%20b%0d%0aX: y\r\n"), "400 bad_header"},
            {get_with("X: a%0A\r\n"), "400 bad_header"},
            {get_with("X: a%00\r\n"), "400 bad_header"},
            {get_with("X: a%20b\tc\r\n"), "served"},
            {get_with("A: 1\r\nB: 1\r\nC: 1\r\nD: 1\r\nE: 1\r\nF: 1\r\nG: 1\r\n"), "served"},
            {get_with("A: 1\r\nB: 1\r\nC: 1\r\nD: 1\r\nE: 1\r\nF: 1\r\nG: 1\r\nH: 1\r\n"),
             "431 too_many_headers"},
            {get_with("Authorization: a\r\nAuthorization: b\r\n"), "400 repeated_header"},
        });
    }

    TEST_CASE("HTTP/1.1 needs exactly one host") {
        check_rows({
            {"GET /v1/jobs HTTP/1.1\r\n\r\n", "400 bad_host"},
            {"GET /v1/jobs HTTP/1.1\r\nHost:\r\n\r\n", "400 bad_host"},
            {"GET /v1/jobs HTTP/1.1\r\nHost: a/b\r\n\r\n", "400 bad_host"},
            {get_with("Host: a\r\n"), "400 repeated_header"},
            {get_with("hOST: b\r\n"), "400 repeated_header"},
        });
    }

    TEST_CASE("a body has one length, of digits, within the limit") {
        check_rows({
            {post_with("Content-Length: 5\r\nTransfer-Encoding: chunked\r\n"),
             "400 ambiguous_length"},
            {post_with("Transfer-Encoding: chunked\r\nContent-Length: 5\r\n"),
             "400 ambiguous_length"},
            {"POST /v1/jobs HTTP/1.0\r\nTransfer-Encoding: chunked\r\n\r\n",
             "400 ambiguous_length"},
            {post_with("Content-Length: 5\r\nContent-Length: 5\r\n"), "400 repeated_header"},
            {post_with("Content-Length: 5, 5\r\n"), "400 bad_content_length"},
            {post_with("Content-Length: abc\r\n"), "400 bad_content_length"},
            {post_with("Content-Length: 0x5\r\n"), "400 bad_content_length"},
            {post_with("Content-Length: +5\r\n"), "400 bad_content_length"},
            {post_with("Content-Length: -1\r\n"), "400 bad_content_length"},
            {post_with("Content-Length: 5 5\r\n"), "400 bad_content_length"},
            {post_with("Content-Length:\r\n"), "400 bad_content_length"},
            {post_with("Content-Length: 1001\r\n"), "413 body_too_large"},
            {post_with("Content-Length: 18446744073709551617\r\n"), "413 body_too_large"},
            {post_with("Transfer-Encoding: xchunked\r\n"), "501 transfer_encoding_not_supported"},
            {post_with("Transfer-Encoding: gzip, chunked\r\n"),
             "501 transfer_encoding_not_supported"},
            {post_with("Transfer-Encoding: chunked, chunked\r\n"),
             "501 transfer_encoding_not_supported"},
            {post_with("Transfer-Encoding: chunked\r\nTransfer-Encoding: chunked\r\n"),
             "400 repeated_header"},
            {post_with("Transfer-Encoding:\r\n"), "501 transfer_encoding_not_supported"},
            {post_with("Content-Length: 5\r\nContent-Encoding: gzip\r\n"),
             "415 content_encoding_not_supported"},
            {post_with("Content-Length: 5\r\nExpect: 200-ok\r\n"), "417 expectation_not_supported"},
            {get_with("Range: bytes=0-,0-\r\n"), "400 multiple_ranges"},
        });
    }

    TEST_CASE("a body where none belongs is refused") {
        check_rows({
            {get_with("Content-Length: 5\r\n"), "400 body_not_allowed"},
            {get_with("Transfer-Encoding: chunked\r\n"), "400 body_not_allowed"},
            {"HEAD /v1/jobs HTTP/1.1\r\nHost: a\r\nContent-Length: 5\r\n\r\n",
             "400 body_not_allowed"},
            {"DELETE /v1/jobs/" + some_id + " HTTP/1.1\r\nHost: a\r\nContent-Length: 5\r\n\r\n",
             "400 body_not_allowed"},
            {"OPTIONS /v1/jobs HTTP/1.1\r\nHost: a\r\nContent-Length: 5\r\n\r\n",
             "400 body_not_allowed"},
            {"POST /v1/jobs/" + some_id +
                 "/cancel HTTP/1.1\r\nHost: a\r\nContent-Length: 5\r\n\r\n",
             "400 body_not_allowed"},
        });
    }

    TEST_CASE("an unknown path is 404, a known one with another method 405 and Allow") {
        check_rows({
            {get_of("/"), "404 not_found"},
            {get_of("//v1/jobs"), "404 not_found"},
            {get_of("/v1/jobs/"), "404 not_found"},
            {get_of("/v1%2fjobs"), "404 not_found"},
            {get_of("/v1/job%73"), "404 not_found"},
            {get_of("/v1/jobs/" + some_id + "/"), "404 not_found"},
            {get_of("/v1/jobs/" + some_id.substr(1)), "400 id_malformed"},
            {get_of("/v1/jobs/" + some_id + "0"), "400 id_malformed"},
            {get_of("/v1/jobs/01arz3ndektsv4rrffq69g5fav"), "400 id_malformed"},
            {"PUT /v1/jobs HTTP/1.1\r\nHost: a\r\n\r\n", "405 method_not_allowed"},
            {"OPTIONS /nowhere HTTP/1.1\r\nHost: a\r\n\r\n", "404 not_found"},
        });
        try {
            (void)vetted("PUT /v1/jobs HTTP/1.1\r\nHost: a\r\n\r\n");
            FAIL("served");
        } catch (const RefusedHead& refusal) {
            REQUIRE(refusal.headers().size() == 1);
            CHECK(refusal.headers()[0].first == "Allow");
            CHECK(refusal.headers()[0].second == "POST, GET, HEAD, OPTIONS");
        }
    }

    TEST_CASE("OPTIONS is answered with the methods of the path") {
        const Head head = vetted("OPTIONS /v1/jobs HTTP/1.1\r\nHost: a\r\n\r\n");
        const Response answer = head.route->handler(head.request);
        CHECK(answer.status == 204);
        REQUIRE(answer.headers.size() == 1);
        CHECK(answer.headers[0].second == "POST, GET, HEAD, OPTIONS");
    }

    TEST_CASE("a vetted head says what was sent") {
        const Head head = vetted("GET /v1/jobs/" + some_id +
                                 "?format=a%20b+c&&tag=%C3%A9&flag HTTP/1.1\r\nHost: a\r\n"
                                 "X-Value: \t a%20b \r\nAccept: a\r\nACCEPT: b\r\n\r\n");
        CHECK(head.request.method == "GET");
        CHECK(head.request.path == "/v1/jobs/" + some_id);
        CHECK(head.request.captures == std::vector<std::string>{some_id});
        CHECK(head.request.query == std::map<std::string, std::string>{
                                        {"format", "a b c"}, {"tag", "\xc3\xa9"}, {"flag", ""}});
        CHECK(head.request.header("x-value") == "a%20b");  // headers are not decoded
        CHECK(head.request.header("accept") == "a, b");
        CHECK(head.request.header("absent") == "");
        CHECK_FALSE(head.has_body());

        const Head post = vetted(post_with("Content-Length: 7\r\nExpect: 100-Continue\r\n"));
        CHECK(post.content_length == 7);
        CHECK(post.awaits_continue);
        CHECK_FALSE(post.chunked);
        CHECK(vetted(post_with("Transfer-Encoding: Chunked\r\n")).chunked);
    }

    TEST_CASE("of a head, only what was vetted goes on to the library") {
        const std::string path = "/v1/jobs/" + some_id;
        const std::string fields =
            " HTTP/1.0\r\nHost: a\r\nConnection: keep-alive\r\nRange: bytes=0-1\r\n"
            "Accept-Encoding: gzip\r\nContent-Type: multipart/form-data; boundary=B\r\n";
        for (const std::string method : {"GET", "HEAD", "DELETE"}) {
            CAPTURE(method);
            CHECK(canonical_head(vetted(method + " " + path + "?a=b?c" + fields + "\r\n")) ==
                  method + " " + path + " HTTP/1.1\r\n\r\n");
        }
        CHECK(canonical_head(vetted("POST /v1/jobs" + fields + "Content-Length: 5\r\n\r\n")) ==
              "POST /v1/jobs HTTP/1.1\r\n\r\n");
        CHECK(canonical_head(
                  vetted(post_with("Transfer-Encoding: chunked\r\nExpect: 100-CONTINUE\r\n"))) ==
              "POST /v1/jobs HTTP/1.1\r\nExpect: 100-continue\r\n\r\n");
        CHECK(canonical_head(vetted(post_with("Expect: 100-continue\r\n"))) ==
              "POST /v1/jobs HTTP/1.1\r\n\r\n");  // there is no body to ask for
    }

    TEST_CASE("a refused HEAD is answered without a body") {
        for (const std::string method : {"HEAD", "GET"}) {
            try {
                (void)vetted(method + " /nowhere HTTP/1.1\r\nHost: a\r\n\r\n");
                FAIL("served");
            } catch (const RefusedHead& refusal) {
                CHECK(refusal.is_without_body() == (method == "HEAD"));
            }
        }
    }

    TEST_CASE("the end of a head is found however the bytes are cut") {
        const std::string head = get_with("X: y\r\n");
        const std::string bytes = head + "GET / HTTP/1.1\r\n\r\n";
        for (std::size_t cut = 0; cut < head.size(); ++cut) {
            CAPTURE(cut);
            CHECK_FALSE(head_length(bytes.substr(0, cut), 0).has_value());
            CHECK(head_length(bytes, cut) == head.size());
        }
        CHECK(head_length("GET / HTTP/1.1\n", 0) == 15);
        CHECK(head_length("\x16\x03\x01", 0) == 3);
        CHECK(head_length("\r\n", 0) == 2);
    }
}
