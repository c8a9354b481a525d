#include "api/base64.h"

#include <doctest/doctest.h>

namespace lastflat::api {

TEST_SUITE("api/base64") {
    TEST_CASE("the examples of RFC 4648 are read, with and without padding") {
        CHECK(decode_base64("") == "");
        CHECK(decode_base64("Zg==") == "f");
        CHECK(decode_base64("Zg") == "f");
        CHECK(decode_base64("Zm8=") == "fo");
        CHECK(decode_base64("Zm9vYmFy") == "foobar");
        CHECK(decode_base64("-_-_") == decode_base64("+/+/"));
    }

    TEST_CASE("what is not base64 is refused") {
        for (const char* text : {"Z", "Zg=", "Zg===", "Z g=", "Zm9v!", "Zh==", "====", "=Zg="}) {
            CAPTURE(text);
            CHECK_FALSE(decode_base64(text).has_value());
        }
    }
}

}  // namespace lastflat::api
