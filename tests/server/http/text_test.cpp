#include "server/http/text.h"

#include <doctest/doctest.h>

using namespace lastflat::http;

TEST_SUITE("server/http/text") {
    TEST_CASE("percent-encoding is decoded once and only if whole") {
        CHECK(percent_decoded("a%2541+b", false) == "a%41+b");
        CHECK(percent_decoded("a+%2B", true) == "a +");
        CHECK_FALSE(percent_decoded("%", false).has_value());
        CHECK_FALSE(percent_decoded("%a", false).has_value());
        CHECK_FALSE(percent_decoded("%0x", false).has_value());
    }

    TEST_CASE("parameters are found by name, not by text") {
        CHECK(parameter_of("t; a=\"; b=wrong\"; b=right", "b") == "right");
        CHECK(parameter_of("t; ab=1; b = 2 ", "b") == "2");
        CHECK(parameter_of("t; flag; b=\"\"", "b") == "");
        CHECK_FALSE(parameter_of("t; filename=x", "name").has_value());
        CHECK_FALSE(parameter_of("name=x", "name").has_value());
        CHECK_FALSE(parameter_of("t; b=\"open", "b").has_value());
        CHECK_FALSE(parameter_of("t;", "b").has_value());
        CHECK_FALSE(parameter_of("t; b=", "b").has_value());
    }

    TEST_CASE("tokens and media types") {
        CHECK(is_token("X-a_1!"));
        CHECK_FALSE(is_token(""));
        CHECK_FALSE(is_token("a b"));
        CHECK_FALSE(is_token("a\xc3"));
        CHECK(media_type_of(" Model/OBJ ; charset=x") == "model/obj");
        CHECK(media_type_of("") == "");
        CHECK(trimmed(" \t ") == "");
        CHECK(trimmed("\ta b ") == "a b");
    }
}
