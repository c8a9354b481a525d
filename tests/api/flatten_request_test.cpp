#include "api/flatten_request.h"

#include <doctest/doctest.h>

#include <limits>

#include "api/job.h"
#include "api/object_reader.h"
#include "api/request_json.h"

namespace lastflat::api {
namespace {

std::string pointer_of(const std::string& text) {
    try {
        (void)flatten_request_from_json(text);
    } catch (const InvalidRequest& error) {
        return error.pointer();
    }
    return "accepted";
}

std::string detail_of(const std::string& text) {
    try {
        (void)flatten_request_from_json(text);
    } catch (const InvalidRequest& error) {
        return error.what();
    }
    return "accepted";
}

constexpr const char* everything = R"({
    "units": "in", "surface": {"groups": ["upper"]}, "weld": {"tolerance_mm": 0.01},
    "points": {"toe_point": {"vertex": 80}, "vamp_point": {"position": [180, 3, 60]}},
    "curves": {"centre_front": {"vertices": [80, 240]}, "heel": {"polyline": [[0,0,0],[1,0,9]]},
               "topline": {"from": "a", "to": "b", "via": ["c"]},
               "featherline": {"border_of": {"groups": ["upper", "sole"]}},
               "stitches": {"line": "by hand"}, "vent": {"border_at": {"position": [1, 2, 3]}}},
    "cuts": ["centre_front", "heel"], "seams": ["dart"], "holes": "keep",
    "regions": {"exterior": {"contains": {"vertex": 5200}}, "interior": {}},
    "locks": [{"curve": "centre_front"}, {"curve": "topline", "keep": "total"}],
    "constraints": [{"kind": "range", "curve": "featherline", "min_percent": -1},
                    {"kind": "match", "curve": "heel", "region": "exterior"},
                    {"kind": "pin", "point": "toe_point", "at_mm": [1, 2], "priority": 7},
                    {"kind": "total_area"}],
    "on_conflict": "relax",
    "material": {"stretch_max_percent": 5, "compress_max_percent": 2},
    "method": {"name": "geodesic_fan", "angles": "averaged_conformal"},
    "layout": {"arrangement": "pair"}, "include": ["fan"], "draw": ["fan", "gather"], "tag": "order-4711"})";

constexpr const char* weighed = R"({
    "points": {"toe_point": {"vertex": 80}},
    "weights": {"compression": 4, "zones": [
        {"point": "toe_point", "within_mm": 9, "weight": 3},
        {"curve": "heel", "within_mm": 5, "weight": 0.5},
        {"vertices": [1, 2, 3], "weight": 2}]}})";

}  // namespace

TEST_SUITE("api/flatten_request") {
    TEST_CASE("nothing at all is every default") {
        for (const char* text : {"", " \n", "{}"}) {
            const Request asked = flatten_request_from_json(text).asked;
            CHECK(asked.curves.empty());
            CHECK_FALSE(asked.weld.unit_mm.has_value());
            CHECK(asked.method.name == MethodName::isometric);
            CHECK(request_json(asked).dump() == "{}");
        }
    }

    TEST_CASE("every part of the contract is read") {
        const FlattenRequest request = flatten_request_from_json(everything);
        const Request& asked = request.asked;
        CHECK(asked.weld.unit_mm == 25.4);
        CHECK(asked.weld.groups == std::vector<std::string>{"upper"});
        CHECK(asked.weld.tolerance_mm == 0.01);
        CHECK(asked.points.size() == 2);
        REQUIRE(asked.curves.size() == 6);  // in alphabetical order
        CHECK(std::get<VertexPath>(asked.curves[0].form).vertices == std::vector<Index>{80, 240});
        CHECK(std::get<GroupBorder>(asked.curves[1].form).groups.size() == 2);
        CHECK(std::get<Polyline>(asked.curves[2].form).points.size() == 2);
        CHECK(std::get<NamedLine>(asked.curves[3].form).line == "by hand");
        CHECK(std::get<ShortestPath>(asked.curves[4].form).through ==
              std::vector<std::string>{"a", "c", "b"});
        CHECK(std::get<BorderAt>(asked.curves[5].form).location == Location(Vec3(1, 2, 3)));
        CHECK(asked.cut.seams == std::vector<std::string>{"dart"});
        CHECK(asked.cut.holes == HoleRule::keep);
        REQUIRE(asked.cut.regions.size() == 2);
        CHECK(asked.cut.regions[0].name == "lateral");
        CHECK(asked.cut.regions[0].inside == Location(5200));
        CHECK(asked.cut.regions[1].name == "medial");
        REQUIRE(asked.constraints.size() == 6);
        CHECK(std::get<Lock>(asked.constraints[0].demand).keep == Keep::edges);
        CHECK(std::get<Lock>(asked.constraints[1].demand).keep == Keep::total);
        const auto& range = std::get<Range>(asked.constraints[2].demand);
        CHECK(range.min_percent == -1.0);
        CHECK(range.max_percent == std::numeric_limits<double>::infinity());
        const auto& match = std::get<Match>(asked.constraints[3].demand);
        CHECK(match.with_curve == "heel");
        CHECK(match.region == "lateral");
        CHECK(std::get<Pin>(asked.constraints[4].demand).vertex == 80);
        CHECK(asked.constraints[4].priority == 7);
        CHECK(asked.constraints[4].option == std::vector<std::string>{"constraints", "2"});
        CHECK(std::get<TotalArea>(asked.constraints[5].demand).max_percent == 0.0);
        CHECK(asked.on_conflict == OnConflict::relax);
        CHECK(asked.material->compress_max_percent == 2.0);
        CHECK(asked.method.angles == AngleRule::averaged_conformal);
        CHECK(request.tag == "order-4711");
    }

    TEST_CASE("weights and their zones are read") {
        const Request asked = flatten_request_from_json(weighed).asked;
        CHECK(asked.weights.stretch == 1.0);
        CHECK(asked.weights.compression == 4.0);
        REQUIRE(asked.weights.zones.size() == 3);
        CHECK(asked.weights.zones[0].vertex == 80);
        CHECK(asked.weights.zones[1].curve == "heel");
        CHECK(asked.weights.zones[2].vertices.size() == 3);
    }

    TEST_CASE("a request is written as it may be sent") {
        // Written, read and written again it is the same; so nothing of it is lost on the way.
        for (const char* text : {everything, weighed}) {
            const std::string once = request_json(flatten_request_from_json(text).asked).dump();
            CHECK(request_json(flatten_request_from_json(once).asked).dump() == once);
            auto sent = nlohmann::json::parse(text), written = nlohmann::json::parse(once);
            for (const auto& [field, value] : sent.items()) {
                CAPTURE(field);
                CHECK((written.contains(field) || field == "layout" || field == "tag"));
            }
        }
        CHECK(request_json(flatten_request_from_json(everything).asked)["curves"].dump() ==
              R"({"centre_front":{"vertices":[80,240]},)"
              R"("featherline":{"border_of":{"groups":["upper","sole"]}},)"
              R"("heel":{"polyline":[[0.0,0.0,0.0],[1.0,0.0,9.0]]},"stitches":{"line":"by hand"},)"
              R"("topline":{"from":"a","to":"b","via":["c"]},)"
              R"("vent":{"border_at":{"position":[1.0,2.0,3.0]}}})");
        CHECK(request_json(flatten_request_from_json(everything).asked)["constraints"].dump() ==
              R"([{"kind":"range","curve":"featherline","min_percent":-1.0},)"
              R"({"kind":"match","curve":"heel","with_curve":"heel","region":"lateral"},)"
              R"({"kind":"pin","vertex":80,"at_mm":[1.0,2.0],"priority":7},)"
              R"({"kind":"total_area","min_percent":0.0,"max_percent":0.0}])");
    }

    TEST_CASE("a broken field is named by its JSON pointer") {
        const std::pair<const char*, const char*> table[] = {
            {R"({"unit": "mm"})", "/unit"},
            {R"({"units": "feet"})", "/units"},
            {R"({"units": 0})", "/units"},
            {R"({"surface": {"groups": ["a", ""]}})", "/surface/groups/1"},
            {R"({"surface": []})", "/surface"},
            {R"({"weld": {}})", "/weld"},
            {R"({"weld": {"tolerance_mm": 2}})", "/weld/tolerance_mm"},
            {R"({"points": {"p": {"vertex": 1, "position": [1,2,3]}}})", "/points/p"},
            {R"({"points": {"p": {"position": [1,2]}}})", "/points/p/position"},
            {R"({"curves": {"heel": {"vertices": [1, -2]}}})", "/curves/heel/vertices/1"},
            {R"({"curves": {"heel": {"vertices": [1, 2.5]}}})", "/curves/heel/vertices/1"},
            {R"({"curves": {"heel": {"vertices": [1, 4294967296]}}})", "/curves/heel/vertices/1"},
            {R"({"curves": {"heel": {"vertices": [1, 18446744073709551615]}}})",
             "/curves/heel/vertices/1"},
            {R"({"curves": {"heel": {"vertices": [1]}}})", "/curves/heel/vertices"},
            {R"({"curves": {"heel": {}}})", "/curves/heel"},
            {R"({"curves": {"heel": {"vertices": [1,2], "polyline": [[0,0,0],[1,1,1]]}}})",
             "/curves/heel"},
            {R"({"curves": {"heel": {"from": "a"}}})", "/curves/heel"},
            {R"({"curves": {"a/b~c": {"vertices": "x"}}})", "/curves/a~1b~0c/vertices"},
            {R"({"curves": {"": {"vertices": [1,2]}}})", "/curves/"},
            {R"({"curves": {"heel": {"border_at": {}}}})", "/curves/heel/border_at"},
            {R"({"curves": {"heel": {"vertices": [1,2], "border_at": {"vertex": 1}}}})",
             "/curves/heel"},
            {R"({"cuts": "heel"})", "/cuts"},
            {R"({"seams": [1]})", "/seams/0"},
            {R"({"holes": "fill"})", "/holes"},
            {R"({"regions": {"a": {"contain": {}}}})", "/regions/a/contain"},
            {R"({"regions": {"lateral": {}, "exterior": {}}})", "/regions/lateral"},
            {R"({"locks": [{"keep": "edges"}]})", "/locks/0"},
            {R"({"locks": [{"curve": "a", "keep": "all"}]})", "/locks/0/keep"},
            {R"({"locks": [{"curve": "a"}, {"curve": "a"}]})", "/locks/1"},
            {R"({"constraints": [{"curve": "a"}]})", "/constraints/0"},
            {R"({"constraints": [{"kind": "glue", "curve": "a"}]})", "/constraints/0/kind"},
            {R"({"constraints": [{"kind": "range", "curve": "a"}]})", "/constraints/0"},
            {R"({"constraints": [{"kind": "range", "curve": "a", "min_percent": 2, "max_percent": 1}]})",
             "/constraints/0"},
            {R"({"constraints": [{"kind": "straight", "curve": "a", "keep": "total"}]})",
             "/constraints/0/keep"},
            {R"({"locks": [{"curve": "a"}], "constraints": [{"kind": "lock", "curve": "a", "region": "b"}]})",
             "/constraints/0"},
            {R"({"constraints": [{"kind": "straight", "curve": "a"}, {"kind": "straight", "curve": "a"}]})",
             "/constraints/1"},
            {R"({"constraints": [{"kind": "pin", "vertex": 3}]})", "/constraints/0"},
            {R"({"constraints": [{"kind": "pin", "point": "p", "at_mm": [0, 0]}]})",
             "/constraints/0/point"},
            {R"({"constraints": [{"kind": "pin", "vertex": 1, "at_mm": [0]}]})",
             "/constraints/0/at_mm"},
            {R"({"constraints": [{"kind": "total_area", "priority": 0.5}]})",
             "/constraints/0/priority"},
            {R"({"on_conflict": "maybe"})", "/on_conflict"},
            {R"({"weights": {"stretch": 0}})", "/weights/stretch"},
            {R"({"weights": {"zones": [{"weight": 2}]}})", "/weights/zones/0"},
            {R"({"weights": {"zones": [{"curve": "a", "weight": 2}]}})", "/weights/zones/0"},
            {R"({"weights": {"zones": [{"curve": "a", "within_mm": 5}]}})", "/weights/zones/0"},
            {R"({"weights": {"stretch": 2}, "method": {"name": "mips"}})", "/weights"},
            {R"({"material": {"stretch_max_percent": 5}})", "/material"},
            {R"({"method": {"name": "magic"}})", "/method/name"},
            {R"({"method": {"name": "isometric", "border": "circle"}})", "/method/border"},
            {R"({"method": {"name": "mean_value", "angles": "curvature"}})", "/method/angles"},
            {R"({"layout": {"arrangement": "heap"}})", "/layout/arrangement"},
            {R"({"tag": "a\u0000b"})", "/tag"},
            {R"([])", ""},
        };
        for (const auto& [text, pointer] : table) {
            CAPTURE(text);
            CHECK(pointer_of(text) == pointer);
        }
    }

    TEST_CASE("an error lists what there is instead") {
        const std::string known =
            "nown here: constraints, curves, cuts, draw, features, holes, include, last_length_mm";
        CHECK(detail_of(R"({"surfeit": 1})").find("unknown field; k" + known) == 0);
        CHECK(detail_of(R"({"lock": []})").find("unknown field; did you mean 'locks'? K" + known) ==
              0);
        CHECK(detail_of(R"({"units": "feet"})") == "must be one of: mm, cm, m, in");
        CHECK(detail_of(R"({"holes": "kep"})") ==
              "must be one of: auto, keep, open; did you mean 'keep'?");
    }

    TEST_CASE("one quantity is drawn by colour, beside the fan") {
        const auto drawn = [](const char* text) { return flatten_request_from_json(text).asked; };
        CHECK(drawn("{}").shading == Shading::area);
        CHECK(drawn(R"({"draw": ["shear", "fan"]})").shading == Shading::shear);
        CHECK(drawn(R"({"draw": ["shear", "fan"]})").draw_fan);
        CHECK_FALSE(drawn(R"({"draw": ["plain"]})").draw_fan);
        CHECK(pointer_of(R"({"draw": ["area", "gather"]})") == "/draw/1");
        CHECK(pointer_of(R"({"draw": ["fan", "fan"]})") == "/draw/1");
        CHECK(pointer_of(R"({"draw": ["fan", "area", "gather"]})") == "/draw");
        CHECK(pointer_of(R"({"draw": ["strain"]})") == "/draw/0");
        CHECK_FALSE(drawn(R"({"draw": ["fan"]})").include_fan);
        CHECK(drawn(R"({"include": ["fan"]})").include_fan);
        CHECK(pointer_of(R"({"include": ["spokes"]})") == "/include/0");
    }

    TEST_CASE("documents that cannot be read are refused, not guessed") {
        for (const char* text : {"{", "{\"a\": nul}", "{\"tag\": \"\xFF\"}", "{} {}",
                                 "{\"tag\": 1e999}", "\xEF\xBB"}) {
            CAPTURE(text);
            CHECK(detail_of(text).find("cannot be read") != std::string::npos);
        }
        CHECK(detail_of(R"({"tag": "a", "tag": "b"})").find("'tag' stands twice") !=
              std::string::npos);
        CHECK(detail_of("{\"tag\":" + std::string(100, '[') + std::string(100, ']') + "}")
                  .find("deeper") != std::string::npos);
    }

    TEST_CASE("limits hold") {
        RequestLimits limits;
        limits.curve_vertices = 3;
        CHECK_THROWS_AS((void)flatten_request_from_json(
                            R"({"curves": {"a": {"vertices": [1,2,3,4]}}})", limits),
                        InvalidRequest);
        limits = {};
        limits.bytes = 10;
        CHECK_THROWS_AS((void)flatten_request_from_json(R"({"tag": "abcdef"})", limits),
                        InvalidRequest);
    }
}

}  // namespace lastflat::api
