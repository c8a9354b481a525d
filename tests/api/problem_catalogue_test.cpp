#include "api/problem_catalogue.h"

#include <doctest/doctest.h>

#include <map>
#include <sstream>

#include "tests/api/contract_document.h"

namespace lastflat::api {
namespace {

/// "404" or "404, 422" by code, from the tables in the description of ProblemCode.
std::map<std::string, std::string> documented_statuses() {
    std::map<std::string, std::string> statuses;
    std::istringstream lines(test::schema("ProblemCode").at("description").get<std::string>());
    for (std::string line; std::getline(lines, line);) {
        if (line.rfind("| `", 0) != 0) continue;
        const std::size_t code_end = line.find('`', 3), begin = line.find("| ", code_end) + 2;
        CHECK(statuses
                  .emplace(line.substr(3, code_end - 3),
                           line.substr(begin, line.find(" |", begin) - begin))
                  .second);
    }
    return statuses;
}

}  // namespace

TEST_SUITE("api/problem_catalogue") {
    TEST_CASE("the catalogue has the codes and statuses that openapi.json documents, and no more") {
        const auto documented = documented_statuses();
        std::set<std::string> codes;
        for (const CataloguedProblem& line : problem_catalogue) {
            const std::string code(line.code);
            CAPTURE(code);
            CHECK(codes.insert(code).second);
            std::string statuses = std::to_string(line.status);
            if (line.status_in_content != line.status)
                statuses += ", " + std::to_string(line.status_in_content);
            REQUIRE(documented.count(code) == 1);
            CHECK(documented.at(code) == statuses);
        }
        CHECK(codes.size() == documented.size());
        CHECK(codes == test::schema("ProblemCode").at("enum").get<std::set<std::string>>());
    }

    TEST_CASE("a code is found by its word, and its title is that in words") {
        const ProblemCode code = ProblemCode::read("asset_not_found");
        CHECK(code == ProblemCode("asset_not_found"));
        CHECK(code.title() == "asset not found");
        CHECK(code.status() == 404);
        CHECK(code.status_in_content() == 422);
        CHECK_THROWS_AS((void)ProblemCode::read("asset"), std::out_of_range);
    }
}

}  // namespace lastflat::api
