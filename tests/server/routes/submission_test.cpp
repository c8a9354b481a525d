#include "server/routes/submission.h"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "api/object_reader.h"
#include "api/refusal.h"

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

/// A body that is no form: {its media type, its bytes} and one header, one query.
struct Plain {
    const char* type = "model/obj";
    std::string bytes = "v 0 0 0";
    std::string constraints{};  ///< X-Flatten-Constraints
    std::string asset{};        ///< ?asset_id=
};

http::Request request_of(const Plain& plain) {
    http::Request request;
    request.headers["content-type"] = plain.type;
    if (!plain.bytes.empty()) request.body = {{"", "", plain.type, plain.bytes}};
    if (!plain.constraints.empty()) request.headers["x-flatten-constraints"] = plain.constraints;
    if (!plain.asset.empty()) request.query["asset_id"] = plain.asset;
    return request;
}

/// The code of the refusal, or the pointer at what is wrong.
std::string fault_of(const Plain& plain) {
    try {
        (void)read_submission(request_of(plain));
    } catch (const api::InvalidRequest& invalid) {
        return invalid.pointer();
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

    TEST_CASE("the model's bytes alone have their constraints in a header") {
        const std::string tag = "eyJ0YWciOiJ0In0";  // {"tag":"t"}
        const Plain plain{"model/obj", "v 1", tag};
        const Submission submission = read_submission(request_of(plain));
        CHECK(submission.model == "v 1");
        CHECK(submission.request == R"({"tag":"t"})");
        CHECK(submission.tag == "t");
        CHECK(read_submission(request_of({})).request.empty());
        CHECK(fault_of({"model/obj", "v 1", "@@"}) == "header_invalid");
        CHECK(fault_of({"model/obj", "v 1", "eyJ0YWciOjF9"}) == "/tag");
        CHECK(fault_of({"model/obj", ""}) == "model_missing");
        CHECK(read_submission(request_of({"", "", "", "digest"})).asset == "digest");
        CHECK(fault_of({"model/obj", "v 1", "", "digest"}) == "model_repeated");
    }

    TEST_CASE("JSON carries model or asset, constraints and a webhook; pointers begin at its top") {
        const auto json = [](const std::string& text) { return Plain{"application/json", text}; };
        const std::string model = R"("model": {"data": "diAwIDAgMA=="})";
        const std::string secret = R"("secret": "whsec_)" + std::string(32, 'A') + "\"";
        const Submission submission =
            read_submission(request_of(json("{" + model +
                                            R"(, "request": {"tag": "t", "units": "mm"}, )"
                                            R"("webhook": {"url": "https://example.com/", )" +
                                            secret + "}}")));
        CHECK(submission.model == "v 0 0 0");
        CHECK(submission.asset.empty());
        CHECK(nlohmann::json::parse(submission.request) ==
              nlohmann::json{{"tag", "t"}, {"units", "mm"}});
        CHECK(submission.tag == "t");
        CHECK(submission.webhook.value().url == "https://example.com/");
        CHECK(read_submission(request_of(json(R"({"model": {"asset_id": "d"}})"))).asset == "d");
        CHECK(fault_of(json("{}")) == "/model");
        CHECK(fault_of(json(R"({"model": {"data": ""}})")) == "model_missing");
        CHECK(fault_of(json("{" + model + R"(, "request": {"units": "feet"}})")) ==
              "/request/units");
        CHECK(fault_of(json("{" + model + R"(, "webhook": {"url": "ftp://x/", )" + secret +
                            "}}")) == "/webhook/url");
        CHECK(fault_of(json("[")) == "");
    }

    TEST_CASE("a form is told by its type in any case, and other types are a model") {
        http::Request request;
        request.headers["content-type"] = "Multipart/Form-Data; boundary=x";
        request.body = {part("asset_id", "d")};
        CHECK(read_submission(request).asset == "d");
        request.headers["content-type"] = "multipart/form";
        CHECK(read_submission(request).model == "d");
    }

    TEST_CASE("constraints that no model could meet are refused at every door") {
        const std::string wrong = R"({"curves": {"a": {"vertices": [1]}}})";
        CHECK_THROWS_AS((void)submitted({part("model", "v"), part("request", wrong)}),
                        api::InvalidRequest);
        CHECK(fault_of({"model/obj", "v", "eyJjdXJ2ZXMiOnsiYSI6eyJ2ZXJ0aWNlcyI6WzFdfX19"}) ==
              "/curves/a/vertices");
        CHECK(fault_of({"application/json", R"({"model": {"data": "dg=="}, "request": )" + wrong +
                                                "}"}) == "/request/curves/a/vertices");
    }
}

}  // namespace lastflat::server
