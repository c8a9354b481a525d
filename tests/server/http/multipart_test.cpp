#include "server/http/multipart.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "server/http/refusal.h"

using namespace lastflat;
using namespace lastflat::http;

namespace {

const std::string plain_type = "multipart/form-data; boundary=XX";

std::string part(const std::string& headers, const std::string& bytes) {
    return "--XX\r\n" + headers + "\r\n\r\n" + bytes + "\r\n";
}

std::string named(const std::string& name) {
    return "Content-Disposition: form-data; name=\"" + name + "\"";
}

std::string verdict(const std::string& type, const std::string& body) {
    try {
        return std::to_string(parse_multipart(type, body, 3).size()) + " parts";
    } catch (const api::Refusal& refusal) {
        CHECK(refusal.problem().status == 400);
        return std::string(refusal.problem().code.word());
    }
}

/// The only part of a body that is gone: its bytes are checked here.
BodyPart only_part(const std::string& headers, const std::string& bytes) {
    const std::string body = part(headers, bytes) + "--XX--\r\n";
    const auto parts = parse_multipart(plain_type, body, 3);
    REQUIRE(parts.size() == 1);
    CHECK(parts[0].bytes == bytes);
    CHECK(parts[0].bytes.data() >= body.data());
    CHECK(parts[0].bytes.data() < body.data() + body.size());
    return parts[0];
}

}  // namespace

TEST_SUITE("server/http/multipart") {
    TEST_CASE("parts keep their order, names, types and every byte") {
        const std::string bytes("\r\n--X\0\r\n--XY\r\n--XX!\r\n", 22);
        const std::string body =
            "preamble\r\n" +
            part(named("model") + "; filename=\"a b.glb\"\r\nContent-Type: Model/GLTF-Binary; a=b",
                 bytes) +
            part(named("request"), "") + "--XX--\r\nepilogue --XX\r\n";
        const auto parts = parse_multipart(plain_type, body, 2);
        REQUIRE(parts.size() == 2);
        CHECK(parts[0].name == "model");
        CHECK(parts[0].file_name == "a b.glb");
        CHECK(parts[0].media_type == "model/gltf-binary");
        CHECK(parts[0].bytes == bytes);
        CHECK(parts[1].name == "request");
        CHECK(parts[1].file_name == "");
        CHECK(parts[1].media_type == "");
        CHECK(parts[1].bytes == "");
    }

    TEST_CASE("every way to write a Content-Disposition is read") {
        CHECK(only_part("content-disposition:form-data;name=m", "x").name == "m");
        const BodyPart swapped =
            only_part("Content-Disposition: form-data; filename=\"f\"; name=\"m\"", "x");
        CHECK(swapped.name == "m");
        CHECK(swapped.file_name == "f");
        CHECK(only_part(named("a;b"), "x").name == "a;b");
        CHECK(only_part(named("a\\\"b"), "x").name == "a\"b");
        CHECK(only_part(named("m") + "; filename=\"C:\\last\\a.obj\"", "x").file_name ==
              "C:\\last\\a.obj");
        CHECK(
            only_part(named("m") + "; filename*=UTF-8''" + std::string(3000, 'a'), "x").file_name ==
            "");
        CHECK(only_part(named("m") + "\r\nContent-Transfer-Encoding: binary\r\nX: y", "x").name ==
              "m");
    }

    TEST_CASE("every way to write the boundary is read") {
        const std::string body = part(named("m"), "x") + "--XX--";
        for (const char* type :
             {"multipart/form-data; boundary=XX", "multipart/form-data; boundary=\"XX\"",
              "multipart/form-data; charset=utf-8; BOUNDARY=XX; x=y",
              "multipart/form-data; boundary=\"XX\"; charset=utf-8",
              "multipart/form-data;boundary=XX"}) {
            CAPTURE(type);
            CHECK(verdict(type, body) == "1 parts");
        }
        const std::string spaced = "--a b\r\n" + named("m") + "\r\n\r\nx\r\n--a b--";
        CHECK(verdict("multipart/form-data; boundary=\"a b\"", spaced) == "1 parts");
        for (const std::string& type : std::vector<std::string>{
                 "multipart/form-data", "multipart/form-data; boundary=",
                 "multipart/form-data; boundary=\"XX", "multipart/form-data; boundary=X\\X",
                 "multipart/form-data; boundary=" + std::string(71, 'X')}) {
            CAPTURE(type);
            CHECK(verdict(type, body) == "bad_multipart");
        }
    }

    TEST_CASE("padding after a boundary is allowed, other text makes it content") {
        CHECK(verdict(plain_type, "--XX \t\r\n" + named("m") + "\r\n\r\nx\r\n--XX-- \r\n") ==
              "1 parts");
        (void)only_part(named("m"), "a\r\n--XXY\r\nb");
        (void)only_part(named("m"), "a\r\n--XX--Y\r\nb");
    }

    TEST_CASE("a form without parts is empty, not broken") {
        CHECK(verdict(plain_type, "--XX--\r\n") == "0 parts");
        CHECK(verdict(plain_type, "\r\n--XX--") == "0 parts");
    }

    TEST_CASE("a body that was cut off is never taken for complete") {
        const std::string body = part(named("m"), "content") + part(named("n"), "more") + "--XX--";
        for (std::size_t size = 0; size < body.size(); ++size) {
            CAPTURE(size);
            CHECK(verdict(plain_type, body.substr(0, size)) == "bad_multipart");
        }
        CHECK(verdict(plain_type, body) == "2 parts");
    }

    TEST_CASE("a broken part is refused") {
        for (const std::string& headers : std::vector<std::string>{
                 "X: y", "Content-Disposition: form-data", "Content-Disposition: form-data; name",
                 "Content-Disposition: form-data; name=\"m",
                 "Content-Disposition: file; name=\"m\"", named("m") + "\r\n" + named("m"),
                 named("a\tb"), named("\xff"), named(std::string(256, 'n')),
                 named("m") + "\r\nno colon", named("m") + "\r\nContent-Transfer-Encoding: base64",
                 named("m") + "\r\nX: " + std::string(4096, 'x')}) {
            CAPTURE(headers);
            CHECK(verdict(plain_type, part(headers, "x") + "--XX--") == "bad_multipart");
        }
        CHECK(verdict(plain_type, "--XX\r\n" + named("m") + "\r\n--XX--") == "bad_multipart");
        CHECK(verdict(plain_type, "--XX\r\n--XX--") == "bad_multipart");
    }

    TEST_CASE("more parts than allowed are refused") {
        std::string body;
        for (int i = 0; i < 3; ++i) body += part(named("m"), "x");
        CHECK(verdict(plain_type, body + "--XX--") == "3 parts");
        CHECK(verdict(plain_type, body + part(named("m"), "x") + "--XX--") == "too_many_parts");
    }
}
