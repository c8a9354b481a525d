#include "server/routes/result_format.h"

#include <doctest/doctest.h>

#include "api/refusal.h"

namespace lastflat::server {
namespace {

ResultFormat format_for(const std::string& accept, const std::string& query = "") {
    http::Request request;
    if (!accept.empty()) request.headers["accept"] = accept;
    if (!query.empty()) request.query["format"] = query;
    return negotiated_format(request);
}

}  // namespace

TEST_SUITE("server/routes/result_format") {
    TEST_CASE("the best weighted type wins, JSON when nothing is said") {
        CHECK(format_for("") == ResultFormat::json);
        CHECK(format_for("*/*") == ResultFormat::json);
        CHECK(format_for("image/*") == ResultFormat::svg);
        CHECK(format_for("model/*") == ResultFormat::glb);
        CHECK(format_for("application/json;q=0.5, model/OBJ") == ResultFormat::obj);
        CHECK(format_for("text/html, */*;q=0.1") == ResultFormat::json);
        CHECK(format_for("application/json;q=0, */*") == ResultFormat::svg);
        CHECK(format_for("text/html", "glb") == ResultFormat::glb);
    }

    TEST_CASE("a type that there is not is refused with the list") {
        for (const auto& [accept, query, status] :
             {std::tuple("text/html", "", 406), std::tuple("", "dxf", 400),
              std::tuple("image/svg+xml;q=0", "", 406)}) {
            try {
                (void)format_for(accept, query);
                FAIL("no error");
            } catch (const api::Refusal& refusal) {
                CHECK(refusal.problem().status == status);
                CHECK(std::string(refusal.what()).find("image/svg+xml") != std::string::npos);
            }
        }
    }

    TEST_CASE("gzip is sent to those who take it") {
        const auto takes = [](const char* accepted) {
            http::Request request;
            request.headers["accept-encoding"] = accepted;
            return accepts_gzip(request);
        };
        CHECK(takes("gzip, deflate, br"));
        CHECK(takes("br;q=1.0, *;q=0.1"));
        CHECK_FALSE(takes("br"));
        CHECK_FALSE(takes("gzip;q=0, *"));
        CHECK_FALSE(accepts_gzip({}));
    }

    TEST_CASE("one range is cut out, others are ignored, those outside refused") {
        const auto range = [](const char* text) {
            http::Request request;
            request.headers["range"] = text;
            const auto wanted = wanted_range(request, 100);
            return wanted ? std::to_string(wanted->first) + "-" + std::to_string(wanted->last)
                          : std::string("all");
        };
        CHECK(range("bytes=0-9") == "0-9");
        CHECK(range("bytes=90-") == "90-99");
        CHECK(range("bytes=-10") == "90-99");
        CHECK(range("bytes=-1000") == "0-99");
        CHECK(range("bytes=50-99999999999") == "50-99");
        for (const char* text : {"bytes=9-0", "bytes=-", "bytes=a-b", "lines=0-9", "bytes=1",
                                 "bytes=99999999999999999999999-"})
            CHECK(range(text) == "all");
        for (const char* text : {"bytes=100-", "bytes=100-200", "bytes=-0"})
            CHECK_THROWS_AS((void)range(text), api::Refusal);
    }
}

}  // namespace lastflat::server
