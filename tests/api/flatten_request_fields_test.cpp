// Every field and every bound of the request, by what the wire says: a body and the pointer at
// fault.
#include <doctest/doctest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "api/flatten_request.h"
#include "api/object_reader.h"

namespace lastflat::api {
namespace {

using Json = nlohmann::json;

/// Every field there is, in a request that is accepted. Forms and kinds exclude each other, so
/// there is one of each.
const Json whole = Json::parse(R"({
    "units": "mm", "last_length_mm": 265, "surface": {"groups": ["upper"]},
    "weld": {"coincident": "join", "tolerance_mm": 0.01, "stitch_mm": 0.5},
    "points": {"toe_point": {"vertex": 80}, "vamp_point": {"position": [180, 3, 60]}},
    "curves": {"front": {"vertices": [80, 240]}, "heel": {"polyline": [[0, 0, 0], [1, 0, 9]]},
               "topline": {"from": "a", "to": "b", "via": ["c"]},
               "featherline": {"border_of": {"groups": ["upper", "sole"]}},
               "vent": {"border_at": {"position": [1, 2, 3]}}, "waist": {"line": "drawn"}},
    "cuts": ["front"], "seams": ["dart"], "holes": "keep",
    "regions": {"lateral": {"contains": {"vertex": 5200}}, "medial": {}},
    "locks": [{"curve": "front", "keep": "total", "region": "lateral", "priority": 3}],
    "constraints": [{"kind": "lock", "curve": "heel", "keep": "edges"},
                    {"kind": "range", "curve": "vent", "min_percent": -1, "max_percent": 2},
                    {"kind": "match", "curve": "heel", "region": "lateral",
                     "with_curve": "waist", "with_region": "medial"},
                    {"kind": "straight", "curve": "front"},
                    {"kind": "total_area", "min_percent": -1, "max_percent": 1},
                    {"kind": "pin", "vertex": 7, "at_mm": [1, 2]},
                    {"kind": "pin", "point": "toe_point", "at_mm": [1, 2], "priority": 7}],
    "on_conflict": "relax",
    "weights": {"stretch": 2, "compression": 0.5,
                "zones": [{"curve": "heel", "within_mm": 5, "weight": 3},
                          {"point": "toe_point", "within_mm": 5, "weight": 3},
                          {"vertex": 9, "within_mm": 5, "weight": 3},
                          {"vertices": [1, 2, 3], "weight": 3}]},
    "material": {"stretch_max_percent": 5, "compress_max_percent": 2},
    "method": {"name": "isometric"}, "layout": {"arrangement": "pair"}, "draw": ["fan", "shear"],
    "include": ["fan"],
    "tag": "order-4711"})");

std::string refused_at(const std::string& text) {
    try {
        (void)flatten_request_from_json(text);
    } catch (const InvalidRequest& error) {
        return error.pointer();
    }
    return "accepted";
}

/// The whole request with one value replaced.
std::string pointer_with(const std::string& place, const Json& value) {
    Json changed = whole;
    changed[Json::json_pointer(place)] = value;
    return refused_at(changed.dump());
}

/// Every place in the request: its pointer.
std::vector<std::string> places() {
    std::vector<std::string> found;
    const Json flat = whole.flatten();  // leaves
    for (const auto& [leaf, value] : flat.items()) {
        for (Json::json_pointer at(leaf); !at.empty(); at.pop_back())
            found.push_back(at.to_string());
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

std::vector<int> ids(std::size_t count) {
    std::vector<int> list(count);
    for (std::size_t i = 0; i < count; ++i) list[i] = static_cast<int>(i);
    return list;
}

Json named(std::size_t count, const Json& value) {
    Json object = Json::object();
    for (std::size_t i = 0; i < count; ++i) object["n" + std::to_string(i)] = value;
    return object;
}

}  // namespace

TEST_SUITE("api/flatten_request") {
    TEST_CASE("what is of no type a field has is refused at that field, wherever it stands") {
        REQUIRE(refused_at(whole.dump()) == "accepted");
        CHECK(places().size() > 100);
        for (const std::string& place : places()) {
            CAPTURE(place);
            CHECK(pointer_with(place, nullptr) == place);
            CHECK(pointer_with(place, true) == place);
        }
    }

    TEST_CASE("a name that nobody knows is refused in every object") {
        for (const std::string& place : places()) {
            if (!whole[Json::json_pointer(place)].is_object()) continue;
            CAPTURE(place);
            CHECK(pointer_with(place + "/unheard_of", 1) == place + "/unheard_of");
        }
        CHECK(pointer_with("/unheard_of", 1) == "/unheard_of");
    }

    TEST_CASE("a number is taken up to its bounds and refused beyond") {
        struct Row {
            std::string place;
            double least, most, below, above;
        };
        const Row table[] = {
            {"/units", 1e-6, 1e6, 0.99e-6, 1.01e6},
            {"/last_length_mm", 50, 500, 49.9, 500.1},
            {"/weld/tolerance_mm", 0, 1, -1e-9, 1.01},
            {"/weld/stitch_mm", 0, 2, -1e-9, 2.01},
            {"/points/vamp_point/position/0", -1e6, 1e6, -1.01e6, 1.01e6},
            {"/curves/heel/polyline/1/2", -1e6, 1e6, -1.01e6, 1.01e6},
            {"/curves/front/vertices/1", 0, 2147483647, -1, 2147483648.0},
            {"/regions/lateral/contains/vertex", 0, 2147483647, -1, 2147483648.0},
            {"/locks/0/priority", -1000, 1000, -1001, 1001},
            {"/constraints/1/min_percent", -99, 2, -99.1, 1001},
            {"/constraints/1/max_percent", -1, 1000, -99.1, 1000.1},
            {"/constraints/4/max_percent", -1, 1000, -99.1, 1000.1},
            {"/constraints/5/at_mm/1", -1e5, 1e5, -1.01e5, 1.01e5},
            {"/weights/stretch", 1e-3, 1e3, 0.99e-3, 1.01e3},
            {"/weights/compression", 1e-3, 1e3, 0.99e-3, 1.01e3},
            {"/weights/zones/0/within_mm", 0, 1e4, -1e-9, 1.01e4},
            {"/weights/zones/0/weight", 1e-3, 1e3, 0.99e-3, 1.01e3},
            {"/material/stretch_max_percent", 0, 1000, -1e-9, 1000.1},
            {"/material/compress_max_percent", 0, 1000, -1e-9, 1000.1},
        };
        const auto number = [](double value) {  // whole ones without a point: ids have none
            const auto whole_part = static_cast<std::int64_t>(value);
            return static_cast<double>(whole_part) == value ? Json(whole_part) : Json(value);
        };
        for (const Row& row : table) {
            CAPTURE(row.place);
            for (const double inside : {row.least, row.most})
                CHECK(pointer_with(row.place, number(inside)) == "accepted");
            for (const double outside : {row.below, row.above})
                CHECK(pointer_with(row.place, number(outside)) == row.place);
        }
    }

    TEST_CASE("a list or a name is taken up to its length and refused beyond") {
        struct Row {
            std::string place;
            Json longest, too_long;
        };
        const auto names = [](std::size_t count) { return Json(std::vector<Json>(count, "a")); };
        const Json point{{"vertex", 1}}, curve{{"vertices", {1, 2}}}, nothing = Json::object();
        const Json zone{{"vertex", 1}, {"within_mm", 1}, {"weight", 2}};
        const Row table[] = {
            {"/surface/groups", names(1024), names(1025)},
            {"/cuts", names(1024), names(1025)},
            {"/seams", names(1024), names(1025)},
            {"/curves/topline/via", names(1024), names(1025)},
            {"/curves/featherline/border_of/groups", names(2), names(3)},
            {"/curves", named(256, curve), named(257, curve)},
            {"/regions", named(64, nothing), named(65, nothing)},
            {"/weights/zones", Json(std::vector<Json>(64, zone)),
             Json(std::vector<Json>(65, zone))},
            {"/include", Json::array({"fan"}), {"fan", "fan"}},
            {"/draw", {"fan", "stretch"}, {"fan", "stretch", "fan"}},
            {"/curves/front/vertices", ids(1'000'000), ids(1'000'001)},
            {"/cuts/0", std::string(128, 'x'), std::string(129, 'x')},
            {"/locks/0/curve", std::string(128, 'x'), std::string(129, 'x')},
            {"/curves/waist/line", std::string(128, 'x'), std::string(129, 'x')},
            {"/tag", std::string(256, 'x'), std::string(257, 'x')},
        };
        for (const Row& row : table) {
            CAPTURE(row.place);
            CHECK(pointer_with(row.place, row.longest) == "accepted");
            CHECK(pointer_with(row.place, row.too_long) == row.place);
        }
        Json points = named(1024, point);
        CHECK(refused_at(Json{{"points", points}}.dump()) == "accepted");
        points["one more"] = point;
        CHECK(refused_at(Json{{"points", points}}.dump()) == "/points");
    }

    TEST_CASE("words are those of the contract, each taken") {
        const std::pair<std::string, std::vector<const char*>> table[] = {
            {"/units", {"mm", "cm", "m", "in"}},
            {"/holes", {"auto", "keep", "open"}},
            {"/on_conflict", {"fail", "relax"}},
            {"/locks/0/keep", {"edges", "total"}},
        };
        for (const auto& [place, words] : table) {
            for (const char* word : words) CHECK(pointer_with(place, word) == "accepted");
            CHECK(pointer_with(place, "MM") == place);
        }
        for (const char* method : {"tutte", "chord_length", "shape_preserving", "harmonic",
                                   "wachspress", "mean_value"}) {
            for (const char* border : {"square", "circle", "hull", "floating"})
                CHECK(refused_at(Json{{"method", {{"name", method}, {"border", border}}}}.dump()) ==
                      "accepted");
        }
        for (const char* angles : {"curvature", "averaged_conformal"})
            CHECK(refused_at(
                      Json{{"method", {{"name", "geodesic_fan"}, {"angles", angles}}}}.dump()) ==
                  "accepted");
        for (const char* method : {"virtual_border", "mips", "green_lagrange", "isometric"}) {
            CHECK(refused_at(Json{{"method", {{"name", method}}}}.dump()) == "accepted");
            CHECK(refused_at(Json{{"method", {{"name", method}, {"border", "hull"}}}}.dump()) ==
                  "/method/border");
        }
    }

    TEST_CASE("what only together makes sense is refused where it stands") {
        const std::pair<std::string, std::string> table[] = {
            {R"({"points": {"p": {}}})", "/points/p"},
            {R"({"curves": {"c": {"via": ["a"]}}})", "/curves/c"},
            {R"({"curves": {"c": {"to": "a"}}})", "/curves/c"},
            {R"({"curves": {"c": {"polyline": [[0, 0, 0]]}}})", "/curves/c/polyline"},
            {R"({"curves": {"c": {"border_of": {}}}})", "/curves/c/border_of"},
            {R"({"curves": {"c": {"border_of": {"groups": []}}}})", "/curves/c/border_of/groups"},
            {R"({"curves": {"c": {"line": "a", "from": "a", "to": "b"}}})", "/curves/c"},
            {R"({"constraints": [{"kind": "match", "region": "a"}]})", "/constraints/0"},
            {R"({"constraints": [{"kind": "straight"}]})", "/constraints/0"},
            {R"({"constraints": [{"kind": "pin", "at_mm": [0, 0]}]})", "/constraints/0"},
            {R"({"points": {"p": {"vertex": 1}},
                 "constraints": [{"kind": "pin", "point": "p", "vertex": 1, "at_mm": [0, 0]}]})",
             "/constraints/0/point"},
            {R"({"points": {"p": {"position": [1, 2, 3]}},
                 "constraints": [{"kind": "pin", "point": "p", "at_mm": [0, 0]}]})",
             "/constraints/0/point"},
            {R"({"locks": [{"curve": "a", "region": "exterior"}, {"curve": "a", "region": "lateral"}]})",
             "/locks/1"},
            {R"({"weights": {"zones": [{"vertices": [1, 2], "weight": 2}]}})",
             "/weights/zones/0/vertices"},
            {R"({"weights": {"zones": [{"vertices": [1, 2, 3], "within_mm": 1, "weight": 2}]}})",
             "/weights/zones/0"},
            {R"({"weights": {"zones": [{"curve": "a", "vertex": 1, "within_mm": 1, "weight": 2}]}})",
             "/weights/zones/0"},
            {R"({"locks": [{"curve": "a", "region": "lateral"}, {"curve": "a", "region": "medial"}]})",
             "accepted"},
            {R"({"weights": {"stretch": 1}, "method": {"name": "mips"}})", "accepted"},
        };
        for (const auto& [text, pointer] : table) {
            CAPTURE(text);
            CHECK(refused_at(text) == pointer);
        }
    }
}

}  // namespace lastflat::api
