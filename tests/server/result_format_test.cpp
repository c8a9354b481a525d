#include "server/result_format.h"

#include <doctest/doctest.h>

#include "server/submission.h"

namespace lastflat::server {
namespace {

ResultFormat format_for(const std::string& accept, const std::string& query = "") {
    http::Request request;
    if (!accept.empty()) request.headers["accept"] = accept;
    if (!query.empty()) request.query["format"] = query;
    return negotiated_format(request);
}

}  // namespace

TEST_SUITE("server/result_format") {
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
            } catch (const Refusal& refusal) {
                CHECK(refusal.problem().status == status);
                CHECK(std::string(refusal.what()).find("image/svg+xml") != std::string::npos);
            }
        }
    }
}

}  // namespace lastflat::server
