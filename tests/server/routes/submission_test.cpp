#include "server/routes/submission.h"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "api/object_reader.h"
#include "server/jobs/refusal.h"

namespace lastflat::server {
namespace {

http::BodyPart part(const char* name, std::string_view bytes, const char* file_name = "") {
    return {name, file_name, "", bytes};
}

Submission submitted(std::vector<http::BodyPart> parts) {
    http::Request request;
    request.headers["content-type"] = "multipart/form-data; boundary=x";
    request.body = std::move(parts);
    return read_submission(request);
}

std::string code_of(std::vector<http::BodyPart> parts) {
    try {
        (void)submitted(std::move(parts));
    } catch (const api::Refusal& refusal) {
        return std::string(refusal.problem().code.word());
    }
    return "taken";
}

constexpr char gltf[] =
    R"({"asset": {"version": "2.0"}, "buffers": [{"uri": "my%20last.bin", "byteLength": 3},
    {"uri": "data:application/octet-stream;base64,AAAA", "byteLength": 3}, {"byteLength": 1}]})";

}  // namespace

TEST_SUITE("server/routes/submission") {
    TEST_CASE("the buffers of a glTF that come beside it are put inside") {
        const Submission submission =
            submitted({part("buffers", "abc", "my last.bin"), part("model", gltf)});
        const auto document = nlohmann::json::parse(submission.model);
        CHECK(document["buffers"][0]["uri"] == "data:application/octet-stream;base64,YWJj");
        CHECK(document["buffers"][1]["uri"] == "data:application/octet-stream;base64,AAAA");
        CHECK(document["asset"]["version"] == "2.0");
    }

    TEST_CASE("a buffer without a part, and a part without a buffer, are said") {
        CHECK(code_of({part("model", gltf), part("buffers", "abc", "other.bin")}) ==
              "buffer_missing");
        CHECK(code_of({part("model", gltf), part("buffers", "abc", "my last.bin"),
                       part("buffers", "abc", "more.bin")}) == "part_unused");
        CHECK(code_of({part("model", "v 0 0 0"), part("buffers", "abc", "a.bin")}) ==
              "part_unused");
        CHECK(code_of({part("asset_id", "a"), part("buffers", "abc", "a.bin")}) == "part_unused");
        CHECK_THROWS_AS((void)submitted({part("model", "{"), part("buffers", "abc", "a.bin")}),
                        api::InvalidRequest);
    }

    TEST_CASE("a model or an asset, not both, and a material file beside") {
        CHECK(code_of({part("model", "v 0 0 0"), part("mtl", "newmtl a")}) == "taken");
        CHECK(code_of({part("model", "v 0 0 0"), part("asset_id", "a")}) == "model_missing");
        CHECK(code_of({part("asset_id", "a"), part("request", "{}")}) == "taken");
        CHECK(submitted({part("asset_id", "a"), part("request", R"({"tag": "t"})")}).tag == "t");
        CHECK(code_of({part("request", "{}")}) == "model_missing");
        CHECK(code_of({part("model", "a"), part("model", "b")}) == "part_repeated");
        CHECK(code_of({part("model", "a"), part("options", "{}")}) == "part_unknown");
    }
}

}  // namespace lastflat::server
