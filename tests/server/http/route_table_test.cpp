#include "server/http/route_table.h"

#include <doctest/doctest.h>

#include <stdexcept>

using namespace lastflat::http;

namespace {
Response nothing(const Request&) {
    return {};
}
}  // namespace

TEST_SUITE("server/http/route_table") {
    TEST_CASE("groups match ids anywhere in a pattern") {
        const std::string a(26, 'A');
        const std::string nine(26, '9');
        const RouteTable table({{"GET", "/a/{id}.json", nothing},
                                {"GET", "/a/{id}/b/{id}", nothing},
                                {"POST", "/a/{id}:retry", nothing}});
        CHECK(table.find("GET", "/a/" + a + ".json").captures == std::vector<std::string>{a});
        CHECK(table.find("HEAD", "/a/" + a + "/b/" + nine).captures ==
              std::vector<std::string>{a, nine});
        CHECK(table.find("POST", "/a/" + a + ":retry").route != nullptr);
        CHECK(table.find("GET", "/a/" + a + ":retry").route == nullptr);
        CHECK(table.find("HEAD", "/a/" + a + ":retry").route == nullptr);
        CHECK(table.find("GET", "/a/" + a + ".jso").route == nullptr);
        CHECK(table.find("GET", "/a/{id}.json").route == nullptr);
        CHECK(table.find("GET", "").route == nullptr);
        CHECK(table.allowed("/a/" + a + ":retry") == "POST, OPTIONS");
        CHECK(table.allowed("/a") == "");
    }

    TEST_CASE("a route that contradicts itself is refused") {
        CHECK_THROWS_AS(RouteTable({{"GET", "/", nothing, true}}), std::invalid_argument);
        CHECK_THROWS_AS(RouteTable({{"POST", "/", nothing, true, true}}), std::invalid_argument);
        CHECK_THROWS_AS(RouteTable({{"POST", "/", Handler()}}), std::invalid_argument);
        CHECK_THROWS_AS(RouteTable({{"HEAD", "/", nothing}}), std::invalid_argument);
        for (const char* pattern : {"", "a", "/a b", "/a?b", "/%61", "/a#b", "/\xC3\xA4"}) {
            CAPTURE(pattern);
            CHECK_THROWS_AS(RouteTable({{"GET", pattern, nothing}}), std::invalid_argument);
        }
    }
}
