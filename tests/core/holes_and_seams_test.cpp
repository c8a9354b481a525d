// Whole runs on pieces with holes, slits and seams.
#include <doctest/doctest.h>

#include <algorithm>

#include "core/flatten.h"
#include "core/numerics/polygon.h"
#include "tests/helpers/constraints.h"
#include "tests/helpers/sheets.h"

namespace lastflat {
namespace {

FlattenResult flatten(const std::string& obj, FlattenOptions options) {
    Progress progress;
    options.request.weld.unit_mm = 1.0;
    FlattenResult result = lastflat::flatten(obj, options, progress);
    for (const FlatRegion& flat : result.regions) {
        CHECK(flat.metrics.flipped_triangles == 0);
        CHECK(flat.metrics.border_crossings == 0);
    }
    for (const ConstraintReport& report : result.constraints) CHECK(report.kept);
    return result;
}

bool is_hole(int i, int j) {
    return i >= 3 && i < 5 && j >= 2 && j < 5;
}

FlattenOptions with(const std::vector<CurveSource>& curves, const CutOptions& cut) {
    FlattenOptions options;
    options.request.curves = curves;
    options.request.cut = cut;
    return options;
}

CurveSource border_at(const std::string& name, const Vec3& position) {
    return {name, BorderAt{position}};
}

std::ptrdiff_t warnings_of(const FlattenResult& result, const std::string& code) {
    return std::count_if(result.warnings.begin(), result.warnings.end(),
                         [&](const Warning& warning) { return warning.code == code; });
}

}  // namespace

TEST_SUITE("core/holes and seams") {
    TEST_CASE("a plane with a hole comes out as it is, and its hole in the outline") {
        const auto result = flatten(test::sheet_obj(8, 8, test::flat, is_hole), {});
        REQUIRE(result.regions.size() == 1);
        const FlatRegion& flat = result.regions[0];
        CHECK(*flat.energy == doctest::Approx(1.0).epsilon(1e-12));
        REQUIRE(flat.outline.holes.size() == 1);
        CHECK(signed_area(flat.outline.points) == doctest::Approx(6400.0));
        CHECK(signed_area(flat.outline.holes[0].points) == doctest::Approx(-600.0));
        CHECK(warnings_of(result, "size_unusual") == 1);  // of 80 mm
        CHECK(result.warnings.size() == 1);
    }

    TEST_CASE("a hole is free, or locked by the name that its place gives it") {
        const std::string obj = test::sheet_obj(8, 8, test::bent, is_hole);
        FlattenOptions options = with({border_at("eyelet", test::bent(3, 3))}, {});
        const auto free = flatten(obj, options);
        options.request.constraints = {lock("eyelet")};
        const auto locked = flatten(obj, options);
        const CurveReport &before = free.regions[0].curves[0], &after = locked.regions[0].curves[0];
        CHECK(before.length_3d_mm == doctest::Approx(after.length_3d_mm));
        CHECK(before.worst_edge_error_mm > 1e-3);
        CHECK(after.worst_edge_error_mm < 1e-9);
        CHECK(*locked.regions[0].energy > *free.regions[0].energy);
        const auto& segments = locked.regions[0].outline.holes[0].segments;
        REQUIRE(segments.size() == 1);
        CHECK(segments[0].curve == "eyelet");
        CHECK(locked.constraints.size() == 1);
    }

    TEST_CASE("the area of a piece with a hole can be kept") {
        FlattenOptions options;
        options.request.constraints = {{TotalArea{}}};
        const auto result = flatten(test::sheet_obj(8, 8, test::bent, is_hole), options);
        CHECK(result.regions[0].metrics.area_error < 1e-9);
    }

    TEST_CASE("every method has an answer on a piece with a hole") {
        for (const MethodName method :
             {MethodName::mean_value, MethodName::geodesic_fan, MethodName::mips,
              MethodName::green_lagrange, MethodName::isometric}) {
            FlattenOptions options;
            options.request.method.name = method;
            const auto result = flatten(test::sheet_obj(8, 8, test::bent, is_hole), options);
            CHECK(result.regions[0].outline.holes.size() == 1);
        }
    }

    TEST_CASE("a tube is opened by itself and unrolls, both sides equally long") {
        const auto result = flatten(test::tube_obj(16, 5), {});
        REQUIRE(result.regions.size() == 1);
        CHECK(*result.regions[0].energy == doctest::Approx(1.0).epsilon(1e-9));
        CHECK(result.regions[0].outline.holes.empty());
        REQUIRE(result.pairs.size() == 1);
        CHECK(result.pairs[0].curve == "seam_1");
        CHECK(result.pairs[0].length_mm == doctest::Approx(5.0));
        CHECK(std::abs(result.pairs[0].difference_mm) < 1e-9);
        CHECK(warnings_of(result, "seam_added") == 1);
        REQUIRE(result.constraints.size() == 1);
        CHECK(title(result.asked[0]) == "seam along seam_1");
    }

    TEST_CASE("a tube that is to stay closed is flattened as a ring") {
        FlattenOptions options;
        options.request.cut.holes = HoleRule::keep;
        const auto result = flatten(test::tube_obj(16, 5), options);
        CHECK(result.regions[0].outline.holes.size() == 1);
        CHECK(*result.regions[0].energy > 1.1);
        CHECK(warnings_of(result, "distortion_extreme") == 1);
    }

    TEST_CASE("all holes are opened if that is asked for, one seam each") {
        FlattenOptions options;
        options.request.cut.holes = HoleRule::open;
        const auto result =
            flatten(test::sheet_obj(9, 9, test::bent,
                                    [](int i, int j) { return i % 3 == 1 && j % 3 == 1; }),
                    options);
        REQUIRE(result.regions.size() == 1);
        CHECK(result.regions[0].outline.holes.empty());
        CHECK(result.pairs.size() == 9);
        CHECK(warnings_of(result, "seam_added") == 9);
        for (const PairReport& pair : result.pairs) CHECK(std::abs(pair.difference_mm) < 1e-9);
    }

    TEST_CASE("too many holes to open are refused") {
        FlattenOptions options;
        options.request.cut.holes = HoleRule::open;
        Progress progress;
        const std::string obj = test::sheet_obj(
            19, 19, test::flat, [](int i, int j) { return i % 2 == 1 && j % 2 == 1; });
        CHECK_THROWS_WITH_AS((void)lastflat::flatten(obj, options, progress),
                             doctest::Contains("more than 64 holes"), Error);
    }

    TEST_CASE("a dart and a slit open, and their sides stay equal") {
        const std::string obj = test::sheet_obj(8, 8, test::bent);
        const std::vector<CurveSource> curves{{"dart", VertexPath{{4, 13, 22}}},
                                              {"slit", VertexPath{{48, 49, 50, 51}}}};
        const auto free = flatten(obj, with(curves, {{"dart", "slit"}, {}}));
        const auto sewn = flatten(obj, with(curves, {{}, {}, {"dart", "slit"}}));
        REQUIRE(sewn.pairs.size() == 2);
        REQUIRE(free.pairs.size() == 2);
        double left_alone = 0.0;
        for (const PairReport& pair : free.pairs)
            left_alone = std::max(left_alone, std::abs(pair.difference_mm));
        CHECK(left_alone > 1e-6);
        for (const PairReport& pair : sewn.pairs) CHECK(std::abs(pair.difference_mm) < 1e-9);
        CHECK(sewn.regions[0].outline.holes.size() == 1);
        CHECK(*sewn.regions[0].energy >= *free.regions[0].energy);
    }

    TEST_CASE("a seam that another one ends on is equal on both parts") {
        const std::vector<CurveSource> curves{
            {"mid", VertexPath{{4, 13, 22, 31, 40, 49, 58, 67, 76}}},
            {"side", VertexPath{{31, 32, 33, 34, 35}}}};
        const auto result =
            flatten(test::sheet_obj(8, 8, test::bent),
                    with(curves, {{}, {{"a", 27}, {"b", 26}, {"c", 62}}, {"mid", "side"}}));
        CHECK(result.regions.size() == 3);
        CHECK(result.pairs.size() == 3);
        CHECK(result.constraints.size() == 3);
        for (const PairReport& pair : result.pairs) CHECK(std::abs(pair.difference_mm) < 1e-9);
    }

    TEST_CASE("a seam whose both sides are locked as well says nothing new") {
        FlattenOptions options = with({{"dart", VertexPath{{4, 13, 22}}}}, {{}, {}, {"dart"}});
        for (const Keep keep : {Keep::edges, Keep::total}) {
            options.request.constraints = {lock("dart", keep)};
            const auto result = flatten(test::sheet_obj(8, 8, test::bent), options);
            CHECK(result.constraints.size() == 3);
            CHECK(result.regions[0].curves[0].length_2d_mm ==
                  doctest::Approx(result.regions[0].curves[0].length_3d_mm).epsilon(1e-9));
        }
    }

    TEST_CASE("a seam needs two sides") {
        Progress progress;
        const auto edge = with({{"edge", VertexPath{{0, 1, 2}}}}, {{}, {}, {"edge"}});
        CHECK_THROWS_WITH_AS(
            (void)lastflat::flatten(test::sheet_obj(4, 4, test::flat), edge, progress),
            doctest::Contains("both sides of it"), Error);
        const auto nothing = with({}, {{}, {}, {"dart"}});
        CHECK_THROWS_WITH_AS(
            (void)lastflat::flatten(test::sheet_obj(4, 4, test::flat), nothing, progress),
            "seam 'dart' names no curve", Error);
    }

    TEST_CASE("a border loop is found by its place, or refused") {
        Progress progress;
        const auto far = with({border_at("eyelet", {0, 0, 900})}, {});
        CHECK_THROWS_WITH_AS(
            (void)lastflat::flatten(test::sheet_obj(4, 4, test::flat), far, progress),
            doctest::Contains("mm away from the nearest border"), Error);
        const CurveSource inside{"eyelet", BorderAt{12}};
        CHECK_THROWS_WITH_AS((void)lastflat::flatten(test::sheet_obj(4, 4, test::flat),
                                                     with({inside}, {}), progress),
                             doctest::Contains("vertex 12 is not on the border"), Error);
    }

    TEST_CASE("the outline is the outer border, however little area it spans") {
        // A tube cut open has an outline whose two long sides lie on each other; the hole's does
        // not.
        FlattenOptions options =
            with({{"heel", VertexPath{{0, 16, 32, 48, 64, 80}}}}, {{"heel"}, {}});
        options.request.cut.holes = HoleRule::keep;
        std::string tube = test::tube_obj(16, 5, [](double angle, int j) {
            return Vec3(20 * std::cos(angle), 20 * std::sin(angle), 12.0 * j);
        });
        const std::size_t face = tube.find("f 41 42 ");  // a cell in the middle, opposite the cut
        REQUIRE(face != std::string::npos);
        tube.erase(face, tube.find('\n', face) + 1 - face);
        const auto result = flatten(tube, options);
        CHECK(*result.regions[0].energy == doctest::Approx(1.0).epsilon(1e-9));
        CHECK(signed_area(result.regions[0].outline.points) > 7000.0);
        CHECK(result.regions[0].outline.holes.at(0).points.size() == 4);
    }

    TEST_CASE("a slit whose sides have changed places is told, by methods that let them") {
        const auto bump = [](int i, int j) {
            const double x = i - 4.0, y = j - 4.0;
            return Vec3(10.0 * i, 10.0 * j, 25.0 * std::exp(-0.2 * (x * x + y * y)));
        };
        int told = 0;
        for (const MethodName method : {MethodName::mips, MethodName::green_lagrange}) {
            FlattenOptions options = with({{"slit", VertexPath{{31, 40, 49}}}}, {{"slit"}, {}});
            options.request.method.name = method;
            options.request.weld.unit_mm = 1.0;
            Progress progress;
            const auto result = lastflat::flatten(test::sheet_obj(8, 8, bump), options, progress);
            const FlatRegion& flat = result.regions[0];
            const bool reversed = signed_area(flat.outline.holes.at(0).points) > 0.0;
            CHECK(reversed == (flat.metrics.border_crossings > 0));
            CHECK(reversed == (warnings_of(result, "border_crosses") == 1));
            told += reversed;
        }
        CHECK(told > 0);
    }

    TEST_CASE("one and two threads give the same bits") {
        FlattenOptions options;
        const std::string obj = test::tube_obj(24, 8, [](double angle, int j) {
            return Vec3((10 + j) * std::cos(angle), 8 * std::sin(angle), 3.0 * j);
        });
        const auto one = flatten(obj, options);
        options.threads = 2;
        const auto two = flatten(obj, options);
        CHECK(one.regions[0].chart.uv == two.regions[0].chart.uv);
    }
}

}  // namespace lastflat
