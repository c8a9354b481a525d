#include "api/session.h"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "api/object_reader.h"

namespace lastflat::api {
namespace {

nlohmann::json merged(const std::string& request, const std::string& patch) {
    return nlohmann::json::parse(merged_request(request, patch));
}

}  // namespace

TEST_SUITE("api/session") {
    TEST_CASE("a patch merges objects, replaces lists whole and takes away what is null") {
        const std::string request =
            R"({"cuts": ["a", "b"], "weights": {"stretch": 2, "compression": 3}, "tag": "x"})";
        const auto result =
            merged(request, R"({"cuts": ["c"], "weights": {"stretch": null}, "tag": null})");
        CHECK(result == nlohmann::json::parse(R"({"cuts": ["c"], "weights": {"compression": 3}})"));
        CHECK(merged("", "{}") == nlohmann::json::object());
        CHECK(merged(" \n", R"({"tag": "y"})")["tag"] == "y");
    }

    TEST_CASE("what is no patch, or leaves no request, is refused by its field") {
        const auto pointer_of = [](const std::string& patch) -> std::string {
            try {
                (void)merged_request("{}", patch);
            } catch (const InvalidRequest& refusal) {
                return refusal.pointer();
            }
            return "taken";
        };
        CHECK(pointer_of("[]").empty());
        CHECK(pointer_of("{").empty());
        CHECK(pointer_of(R"({"weights": {"strech": 1}})") == "/weights/strech");
        CHECK(pointer_of(R"({"tag": "fine"})") == "taken");
    }

    TEST_CASE("a session's members stand beside those of its state") {
        const auto json = nlohmann::json::parse(
            to_json(SessionView{"01M8H77HGB466QWJWFD333JTGQ", 0, 1000}, R"({"revision":1})"));
        CHECK(json["revision"] == 1);
        CHECK(json["durable"] == false);
        CHECK(json["expires_at"] == "1970-01-01T00:00:01.000Z");
    }
}

}  // namespace lastflat::api
