#include "api/nearest_name.h"

#include <doctest/doctest.h>

namespace lastflat::api {

TEST_SUITE("api/nearest_name") {
    TEST_CASE("a letter missing, too much, wrong or exchanged is found") {
        const std::vector<std::string> names{"curves", "cuts", "regions", "locks", "keep"};
        CHECK(nearest_name("lock", names) == "locks");
        CHECK(nearest_name("currves", names) == "curves");
        CHECK(nearest_name("kepp", names) == "keep");
        CHECK(nearest_name("regoins", names) == "regions");
        CHECK(nearest_name("kepe", names) == "keep");
        CHECK(nearest_name("cuts", names) == "cuts");
    }

    TEST_CASE("of several the nearest, and nothing where none is near") {
        CHECK(nearest_name("flat", {"flatten", "flute", "flax"}) == "flax");
        CHECK(nearest_name("seem", {"curves", "tag"}) == std::nullopt);
        CHECK(nearest_name("", {"tag"}) == std::nullopt);
        CHECK(nearest_name("x", {}) == std::nullopt);
        CHECK(nearest_name(std::string(5000, 'a'), {std::string(5001, 'a')}) == std::nullopt);
    }

    TEST_CASE("it is said as a question, or not at all") {
        CHECK(suggestion("kep", {"keep"}) == "; did you mean 'keep'?");
        CHECK(suggestion("magic", {"keep"}).empty());
    }
}

}  // namespace lastflat::api
