#include <doctest/doctest.h>

#include "api/asset.h"
#include "api/constraint_schema.h"
#include "api/flatten_request.h"
#include "api/health.h"
#include "api/map.h"
#include "api/model_report.h"
#include "api/object_reader.h"
#include "api/sample_request.h"
#include "core/inspect.h"
#include "core/sample/sample_last.h"
#include "tests/api/contract_document.h"

namespace lastflat::api {

TEST_SUITE("api/map") {
    TEST_CASE("points and lines are read, in three dimensions and in two") {
        const MapRequest request = map_request_from_json(
            R"({"to_pattern": {"points": [[1, 2, 3]]},
                "to_last": {"region": "lateral", "polylines": [[[1, 2], [3, 4]]]}})");
        CHECK(request.to_pattern->points == Points3{{1, 2, 3}});
        CHECK(request.to_last->region == "lateral");
        CHECK(request.to_last->polylines[0] == Points2{{1, 2}, {3, 4}});
        for (const char* text : {"{}", R"({"to_last": {"points": [[1, 2]]}})",
                                 R"({"to_pattern": {"points": [[1, 2]]}})",
                                 R"({"to_pattern": {"polylines": [[[1, 2, 3]]]}})"}) {
            CAPTURE(text);
            CHECK_THROWS_AS((void)map_request_from_json(text), InvalidRequest);
        }
    }

    TEST_CASE("what was mapped is written as it was asked") {
        Mapped mapped;
        mapped.to_pattern =
            Mapped::ToPattern{{{"lateral", {1, 2}, 0.5}}, {{{"lateral", {{1, 2}, {3, 4}}, 0.25}}}};
        CHECK(to_json(mapped) ==
              R"({"to_pattern":{"points":[{"region":"lateral","uv_mm":[1.0,2.0],)"
              R"("distance_mm":0.5}],"polylines":[[{"region":"lateral",)"
              R"("uv_mm":[[1.0,2.0],[3.0,4.0]],"distance_mm":0.25}]]}})");
        mapped.to_pattern.reset();
        mapped.to_last = Mapped::ToLast{{{{1, 2, 3}, 0.0}}, {{{{1, 2, 3}}, 0.0}}};
        CHECK(to_json(mapped) ==
              R"({"to_last":{"points":[{"position":[1.0,2.0,3.0],"distance_mm":0.0}],)"
              R"("polylines":[{"positions":[[1.0,2.0,3.0]],"distance_mm":0.0}]}})");
    }
}

TEST_SUITE("api/model_report") {
    TEST_CASE("a report says what the model is and why it cannot be flattened") {
        Inspection found;
        found.file_vertices = 4;
        found.groups = {{{"upper", "calf"}, 2}};
        found.border_loops = {{3.5, {1, 2, 3}}};
        found.regions = {{"lateral", 3, 1, 0.5, 3.5, {}}};
        found.repairs = {{"welded", "2 vertices", 2, {{1, 2, 3}}}};
        found.warnings = {{"unit_assumed", "mm", Vec3(1, 2, 3)}};
        auto report = nlohmann::json::parse(to_json(found));
        CHECK(report["flattens"] == true);
        CHECK(report["file"]["groups"].dump() == R"([{"names":["upper","calf"],"triangles":2}])");
        CHECK(report["surface"]["closed"] == false);
        CHECK(report["surface"]["border_positions"].dump() == "[[1.0,2.0,3.0]]");
        CHECK(report["regions"][0]["border_mm"] == 3.5);
        CHECK(report["repairs"][0]["positions"].dump() == "[[1.0,2.0,3.0]]");
        CHECK(report["warnings"][0]["position"].dump() == "[1.0,2.0,3.0]");
        CHECK_FALSE(report.contains("problem"));
        for (const auto& name : test::schema("ModelReport").at("required"))
            CHECK(report.contains(name.get<std::string>()));
        found.fault = Error(ErrorCode::region_not_disk, "it is closed");
        report = nlohmann::json::parse(to_json(found));
        CHECK(report["flattens"] == false);
        CHECK(report["problem"]["code"] == "region_not_disk");
    }
}

TEST_SUITE("api/health") {
    TEST_CASE("health says what it knows") {
        CHECK(to_json(Health{Status::ok, "1.2.3", Health::Jobs{1, 2}}) ==
              R"({"status":"ok","version":"1.2.3","jobs":{"queued":1,"running":2}})");
        CHECK(to_json(Health{Status::store_unavailable, "1.2.3", {}}) ==
              R"({"status":"store_unavailable","version":"1.2.3"})");
        CHECK(version_json("1.2.3") == R"({"version":"1.2.3"})");
    }
}

TEST_SUITE("api/asset") {
    TEST_CASE("an asset is known by its digest") {
        const Asset asset{"abc", 12, 0};
        const std::string text =
            R"({"id":"abc","bytes":12,"created_at":"1970-01-01T00:00:00.000Z"})";
        CHECK(to_json(asset) == text);
        CHECK(to_json(std::vector{asset, asset}) == R"({"items":[)" + text + "," + text + "]}");
        CHECK(to_json(std::vector<Asset>{}) == R"({"items":[]})");
    }
}

TEST_SUITE("api/sample_request") {
    TEST_CASE("the request of the sample last can be read") {
        const SampleLast last = make_sample_last();
        const FlattenRequest request = flatten_request_from_json(sample_request(last));
        CHECK(request.asked.curves.size() == last.curves.size());
        CHECK(request.asked.cut.cuts == std::vector<std::string>{"centre_front", "heel"});
        CHECK(request.asked.constraints.size() == 2);
    }
}

TEST_SUITE("api/constraint_schema") {
    TEST_CASE("the schema stands alone: what it refers to is inside") {
        const std::string contract =
            R"({"components": {"schemas": {"FlattenRequest": {"type": "object"}}, "other": 1}})";
        CHECK(constraint_schema(contract) ==
              R"({"$schema":"https://json-schema.org/draft/2020-12/schema",)"
              R"("title":"The constraints of a flattening",)"
              R"("$ref":"#/components/schemas/FlattenRequest",)"
              R"("components":{"schemas":{"FlattenRequest":{"type":"object"}}}})");
    }
}

}  // namespace lastflat::api
