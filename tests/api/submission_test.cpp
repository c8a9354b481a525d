#include "api/submission.h"

#include <doctest/doctest.h>

#include "api/object_reader.h"

namespace lastflat::api {

TEST_SUITE("api/submission") {
    TEST_CASE("the model is decoded and pointers begin at the document") {
        const auto submission = json_submission_from_json(
            R"({"model": {"data": "diAwIDAgMA=="}, "request": {"tag": "t"}})");
        CHECK(submission.model == "v 0 0 0");
        CHECK(submission.request.tag == "t");
        try {
            (void)json_submission_from_json(
                R"({"model": {"data": ""}, "request": {"units": "x"}})");
            FAIL("no error");
        } catch (const InvalidRequest& error) {
            CHECK(error.pointer() == "/request/units");
        }
        for (const char* text : {R"({})", R"({"model": {}})", R"({"model": {"data": "@"}})",
                                 R"({"model": {"data": ""}, "x": 1})"}) {
            CHECK_THROWS_AS((void)json_submission_from_json(text), InvalidRequest);
        }
    }
}

}  // namespace lastflat::api
