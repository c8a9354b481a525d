#include "api/problem.h"

#include <doctest/doctest.h>

#include <new>

#include "api/object_reader.h"
#include "api/problem_of.h"
#include "core/error.h"

namespace lastflat::api {
namespace {

template <class Thrown>
Problem problem_of_thrown(const Thrown& thrown) {
    return problem_of(std::make_exception_ptr(thrown));
}

}  // namespace

TEST_SUITE("api/problem") {
    TEST_CASE("a problem is written with what it has, and read again") {
        Problem problem("constraints_infeasible", "they cannot");
        CHECK(to_json(problem) ==
              R"({"type":"urn:lastflat:problem:constraints_infeasible",)"
              R"("title":"constraints infeasible","status":422,"detail":"they cannot",)"
              R"("code":"constraints_infeasible"})");
        problem.status = 409;
        problem.pointer = "/locks/0";
        problem.position = {0.1, 1.0 / 3.0, -1e-17};
        problem.triangles = {{1, 2, 3}, {4, 5, 6}};
        problem.conflict = {{"/locks/0", "lock of heel", 0.5, {1, 2, 3}}};
        const std::string text = to_json(problem);
        const Problem read = problem_from_json(text);
        CHECK(read.code == problem.code);
        CHECK(read.status == 409);
        CHECK(read.conflict.size() == 1);
        CHECK(to_json(read) == text);
    }

    TEST_CASE("what is no problem is not read as one") {
        for (const char* text : {"", "{}", R"({"code": "canceled"})",
                                 R"({"code": "unheard_of", "status": 400, "detail": ""})"}) {
            CAPTURE(text);
            CHECK_THROWS_AS((void)problem_from_json(text), std::runtime_error);
        }
    }

    TEST_CASE("broken UTF-8 in a detail leaves a document that can be read") {
        const Problem problem("curve_invalid", "curve '\xff'");
        CHECK(problem_from_json(to_json(problem)).detail == "curve '\xef\xbf\xbd'");
    }

    TEST_CASE("whoever asks for the result of a failed job gets its problem, as a conflict") {
        Problem problem("curve_invalid", "no such curve");
        problem.pointer = "/curves/heel";
        problem.triangles = {{1, 2, 3}};
        const Problem answer = without_result(problem);
        CHECK(answer.status == 409);
        CHECK(answer.code == problem.code);
        CHECK(answer.detail == "the job failed: no such curve");
        CHECK(answer.pointer == problem.pointer);
        CHECK(answer.triangles.empty());
    }
}

TEST_SUITE("api/problem_of") {
    TEST_CASE("an error of core keeps its code, its place and its triangles") {
        Error error(ErrorCode::mesh_not_manifold, "3 edges");
        error.at_option({"curves", "a/b", "vertices", "12"}).at_position({1, 2, 3});
        error.at_triangles({{4, 5, 6}});
        const Problem problem = problem_of_thrown(error);
        CHECK(problem.code.word() == "mesh_not_manifold");
        CHECK(problem.status == 422);
        CHECK(problem.detail == "3 edges");
        CHECK(problem.pointer == "/curves/a~1b/vertices/12");
        CHECK(problem.position == std::array<double, 3>{1, 2, 3});
        CHECK(problem.triangles.size() == 1);
    }

    TEST_CASE(
        "where a field of the request would mend it, a hint says so in the words of the wire") {
        const auto detail = [](ErrorCode code, const std::vector<std::string>& option) {
            return problem_of_thrown(Error(code, "so").at_option(option)).detail;
        };
        CHECK(detail(ErrorCode::method_failed, {"method"}) ==
              "so; use the method \"isometric\", which never folds");
        CHECK(detail(ErrorCode::method_failed, {"constraints"}) == "so");
        CHECK(detail(ErrorCode::region_invalid, {"regions"}) ==
              "so; name those that are meant in \"regions\"");
        CHECK(detail(ErrorCode::region_invalid, {"regions", "lateral"}) == "so");
        Error fight(ErrorCode::constraints_infeasible, "they fight");
        fight.at_option({"locks", "0"}).with_conflict({{{"locks", "0"}, "lock", 0.5, {1, 2, 3}}});
        const Problem problem = problem_of_thrown(fight);
        CHECK(problem.detail ==
              "they fight; leave one out or let it give way (\"on_conflict\": \"relax\")");
        CHECK(problem.conflict.at(0).pointer == "/locks/0");
        CHECK(detail_of(Warning{"unit_assumed", "taken as mm", {}}) ==
              "taken as mm. Send \"units\" to be sure");
        CHECK(detail_of(Warning{"no_fan", "none", {}}) == "none");
    }

    TEST_CASE("a refusal keeps its problem, whatever it tells the operator") {
        const Problem problem =
            problem_of_thrown(Refusal(Problem("store_unavailable", "later"), "/data: disk full"));
        CHECK(problem.code.word() == "store_unavailable");
        CHECK(problem.detail == "later");
        CHECK(problem_of_thrown(Refusal("asset_not_found", "").in_content()).status == 422);
    }

    TEST_CASE("a broken request names its field") {
        const Problem problem = problem_of_thrown(InvalidRequest("/lock", "unknown field"));
        CHECK(problem.code.word() == "invalid_request");
        CHECK(problem.detail == "/lock: unknown field");
        CHECK(problem.pointer == "/lock");
        CHECK(problem_of_thrown(InvalidRequest("", "is empty")).detail == "the request: is empty");
    }

    TEST_CASE("everything else is the program's fault, but for the want of memory") {
        CHECK(problem_of_thrown(std::bad_alloc()).code.word() == "out_of_memory");
        CHECK(problem_of_thrown(std::logic_error("oh")).detail == "an internal error: oh");
        CHECK(problem_of_thrown(7).status == 500);
    }
}

}  // namespace lastflat::api
