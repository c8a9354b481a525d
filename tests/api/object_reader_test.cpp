#include "api/object_reader.h"

#include <doctest/doctest.h>

namespace lastflat::api {
namespace {

std::string repeated(const std::string& part, std::size_t times) {
    std::string text;
    text.reserve(part.size() * times);
    for (std::size_t i = 0; i < times; ++i) text += part;
    return text;
}

std::string list_of(const std::string& item, std::size_t times) {
    return "[" + repeated(item + ",", times - 1) + item + "]";
}

std::string refusal_of(const std::string& text, int depth = 12) {
    try {
        (void)parse_json(text, depth);
    } catch (const InvalidRequest& error) {
        return error.what();
    }
    return "no error";
}

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_SUITE("api/object_reader") {
    TEST_CASE("every value, name, list and object counts") {
        CHECK(refusal_of(list_of("7", 3'999'999)) == "no error");
        for (const auto& [what, text] : {std::pair("numbers", list_of("7", 4'000'000)),
                                         std::pair("lists", list_of("[]", 4'000'000)),
                                         std::pair("objects", list_of("{}", 4'000'000)),
                                         std::pair("names", list_of("{\"a\":1}", 1'333'334))}) {
            CAPTURE(what);
            CHECK(has(refusal_of(text), "more than 4000000 values, names, lists"));
        }
    }

    TEST_CASE("strings may be long, what stands beside them not") {
        const std::string long_text(std::size_t{40} << 20, 'x');
        CHECK(refusal_of("[\"" + long_text + "\"]") == "no error");
        CHECK(has(refusal_of("[" + std::string(std::size_t{33} << 20, ' ') + "1]"),
                  "bytes beside its texts"));
    }

    TEST_CASE("depth counts lists and objects, from the outermost") {
        CHECK(refusal_of(repeated("[", 3) + "1" + repeated("]", 3), 3) == "no error");
        CHECK(refusal_of(R"({"a":{"b":{"c":1}}})", 3) == "no error");
        for (const std::string& text :
             {repeated("[", 4) + repeated("]", 4), repeated(R"({"a":)", 4) + "1" + repeated("}", 4),
              repeated("[", 5'000'000)}) {
            CHECK(has(refusal_of(text, 3), "nested deeper than 3 levels"));
        }
    }

    TEST_CASE("a name stands once in its own object, and as often as one likes elsewhere") {
        CHECK(refusal_of(R"([{"a":1},{"a":{"a":2}}])") == "no error");
        CHECK(has(refusal_of(R"({"a":1,"b":{"a":2},"a":3})"), "'a' stands twice"));
    }

    TEST_CASE("where reading stopped is said in words that JSON can carry") {
        CHECK(has(refusal_of("{\"a\":1,\xFF}"), "line 1, column 8"));
        CHECK(has(refusal_of("[1e999]"), "cannot be read"));
        CHECK(has(refusal_of(""), "cannot be read"));
        CHECK(has(refusal_of("[1] 2"), "cannot be read"));
    }
}

}  // namespace lastflat::api
