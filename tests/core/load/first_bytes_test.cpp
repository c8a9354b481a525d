#include "core/load/first_bytes.h"

#include <doctest/doctest.h>

#include "core/export/write_model.h"
#include "core/sample/sample_last.h"
#include "tests/helpers/errors.h"

namespace lastflat {
namespace {

std::string refused(const std::string& bytes) {
    return test::error_of([&] { check_first_bytes(bytes); });
}

}  // namespace

TEST_SUITE("core/load/first_bytes") {
    TEST_CASE("other formats are named, with those that are read") {
        for (const auto& [bytes, name] :
             {std::pair("\x89PNG\r\n\x1A\n", "a picture (PNG)"),
              std::pair("\xFF\xD8\xFF\xE0", "JPEG"), std::pair("GIF89a", "GIF"),
              std::pair("%PDF-1.7", "PDF"), std::pair("PK\x03\x04", "ZIP"),
              std::pair("Kaydara FBX Binary  ", "FBX"), std::pair("ISO-10303-21;\n", "STEP")}) {
            CAPTURE(name);
            const std::string what = refused(bytes);
            CHECK(test::has(what, "unsupported_model"));
            CHECK(test::has(what, name));
            CHECK(test::has(what, "OBJ, STL, PLY, glTF or GLB"));
        }
    }

    TEST_CASE("web pages, zeros, spaces and headers that are cut off are no models") {
        for (const std::string& bytes :
             {std::string(), std::string(" \n\t"), std::string(200'000, '\0'), std::string(3, '\0'),
              std::string("\xEF\xBB\xBF \n<!DOCTYPE html><html>"), std::string("<HTML>"),
              std::string("<?xml version=\"1.0\"?>"), std::string("glTF\x02\0\0\0", 8),
              std::string("glTF\x02\0\0\0\xFF\0\0\0xxxx", 16)}) {
            CAPTURE(bytes.substr(0, 20));
            CHECK(test::has(refused(bytes), "unreadable_model"));
        }
        CHECK(test::has(refused(std::string("glTF\x02\0\0\0\xFF\0\0\0xxxx", 16)),
                        "announces 255 bytes and has 16"));
    }

    TEST_CASE("what may be a model passes") {
        const std::string blank_header(80, '\0');
        for (const std::string& bytes :
             {std::string("v 0 0 0\n"), std::string("# <html>\n"), std::string("ply\nformat"),
              std::string("solid x"), std::string("{\"asset\":{}}"),
              blank_header + std::string("\x01\0\0\0", 4) + std::string(50, '\0'),
              std::string(5000, '\n') + "v 0 0 0\n"}) {
            CAPTURE(bytes.substr(0, 20));
            CHECK(refused(bytes) == "no error");
        }
        CHECK(refused(write_model_obj(make_sample_last().mesh)) == "no error");
    }
}

}  // namespace lastflat
