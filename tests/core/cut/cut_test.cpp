#include "core/cut/cut.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "core/load/load_model.h"
#include "core/weld/weld.h"
#include "tests/helpers/errors.h"
#include "tests/helpers/regions.h"
#include "tests/helpers/sheets.h"

namespace lastflat {
namespace {

using test::cut;
using test::has;

std::string tube(int around, int up) {
    return test::tube_obj(around, up);
}

std::string cut_error(const std::string& obj, const std::vector<CurveSource>& sources,
                      const CutOptions& options) {
    return test::error_of([&] { (void)cut(obj, sources, options); });
}

const CurveSource front{"front", VertexPath{{0, 8, 16, 24}}},
    back{"back", VertexPath{{4, 12, 20, 28}}};

}  // namespace

TEST_SUITE("core/cut") {
    TEST_CASE("two cuts along a tube leave two disks that share the cuts' lengths") {
        const auto regions =
            cut(tube(8, 3), {front, back}, {{"front", "back"}, {{"a", 9}, {"b", 13}}});
        REQUIRE(regions.size() == 2);
        CHECK(regions[0].name == "a");
        for (const Region& region : regions) {
            CHECK(region.positions.size() == 20);
            CHECK(region.triangles.size() == 24);
            CHECK(region.border.size() == 14);
            REQUIRE(region.runs.size() == 2);
            CHECK(region.runs[0].vertices.size() == 4);
        }
        CHECK(std::find(regions[0].source_vertices.begin(), regions[0].source_vertices.end(), 9) !=
              regions[0].source_vertices.end());
    }

    TEST_CASE("one cut opens the tube to one disk, whose two sides are two runs") {
        const auto regions = cut(tube(8, 3), {front}, {{"front"}, {}});
        REQUIRE(regions.size() == 1);
        CHECK(regions[0].positions.size() == 32 + 4);
        REQUIRE(regions[0].runs.size() == 2);
        CHECK(regions[0].runs[0].vertices != regions[0].runs[1].vertices);
        for (std::size_t i = 0; i < 4; ++i) {
            const auto a = static_cast<std::size_t>(regions[0].runs[0].vertices[i]);
            const auto b = static_cast<std::size_t>(regions[0].runs[1].vertices[i]);
            CHECK(regions[0].source_vertices[a] == regions[0].source_vertices[b]);
        }
    }

    TEST_CASE("a slit that ends inside stays one disk and doubles only what it passes") {
        const auto regions =
            cut(tube(8, 3), {front, {"slit", VertexPath{{4, 12, 20}}}}, {{"front", "slit"}, {}});
        REQUIRE(regions.size() == 1);
        CHECK(regions[0].positions.size() == 36 + 2);  // the slit's inner end stays one vertex
        CHECK(regions[0].border.size() == 8 + 8 + 3 + 3 + 2 + 2);
    }

    TEST_CASE("a closed curve whose start lies inside a region is one run there") {
        // The ring at the bottom begins at vertex 2, in the middle of region a.
        const CurveSource ring{"ring", VertexPath{{2, 3, 4, 5, 6, 7, 0, 1, 2}}};
        const auto regions =
            cut(tube(8, 3), {front, back, ring}, {{"front", "back"}, {{"a", 9}, {"b", 13}}});
        REQUIRE(regions[0].runs.size() == 3);
        CHECK(regions[0].runs[2].vertices.size() == 5);
        CHECK(regions[1].runs[2].vertices.size() == 5);
    }

    TEST_CASE("what is not a disk is named") {
        const std::string ball =
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
        CHECK(
            has(cut_error(ball, {}, {}),
                "region_not_disk /regions/region_1: region 'region_1' is not a disk: it is closed "
                "(no border)"));
    }

    TEST_CASE("a torus with a hole has genus one") {
        std::string torus;
        const int n = 8;
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i < n; ++i) {
                const double a = 2 * M_PI * i / n, b = 2 * M_PI * j / n;
                torus += "v " + std::to_string((3 + std::cos(b)) * std::cos(a)) + " " +
                         std::to_string((3 + std::cos(b)) * std::sin(a)) + " " +
                         std::to_string(std::sin(b)) + "\n";
            }
        }
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i < n; ++i) {
                if (i == 0 && j == 0) continue;
                const auto id = [n](int x, int y) { return std::to_string(y % n * n + x % n + 1); };
                torus += "f " + id(i, j) + " " + id(i + 1, j) + " " + id(i + 1, j + 1) + " " +
                         id(i, j + 1) + "\n";
            }
        }
        CHECK(has(cut_error(torus, {}, {}), "genus 1, 1 border loop(s)"));
    }

    TEST_CASE("choices that cannot be told apart are refused") {
        const std::vector<CurveSource> both{front, back};
        CHECK(has(cut_error(tube(8, 3), both, {{"front", "back"}, {{"a", 9}, {"b", 10}}}),
                  "is the same piece as region 'a'"));
        CHECK(has(cut_error(tube(8, 3), both, {{"front", "back"}, {{"a", 8}}}), "lies on a cut"));
        CHECK(has(cut_error(tube(8, 3), both, {{"front", "back"}, {{"a"}}}), "2 pieces"));
        CHECK(has(cut_error(tube(8, 3), both, {{"front", "side"}, {}}),
                  "curve_invalid /cuts/1: cut 'side' names no curve"));
        CHECK(has(cut_error(tube(8, 3), both, {{"front", "back"}, {{"a", 99}}}),
                  "not on the selected faces"));
    }

    TEST_CASE("a region may be chosen by a place") {
        const auto regions =
            cut(tube(8, 3), {front, back}, {{"front", "back"}, {{"b", Vec3(0, -1, 1.1)}}});
        REQUIRE(regions.size() == 1);
        CHECK(std::find(regions[0].source_vertices.begin(), regions[0].source_vertices.end(), 14) !=
              regions[0].source_vertices.end());
    }
}

TEST_SUITE("core/locate/curves") {
    TEST_CASE("a broken path is named by curve, item and place") {
        CHECK(has(cut_error(tube(8, 3), {{"front", VertexPath{{0, 8, 24}}}}, {}),
                  "curve_invalid /curves/front/vertices/2: curve 'front', item 2: vertices 8 and "
                  "24 share no edge; they are 2.000 mm apart, at 1.0 0.0 1.0"));
        CHECK(has(cut_error(tube(8, 3), {{"front", VertexPath{{0, 99}}}}, {}),
                  "item 1: vertex 99 does not exist"));
        CHECK(has(cut_error(tube(8, 3), {{"front", VertexPath{{0, 8, 0}}}}, {}), "meets itself"));
        CHECK(has(cut_error(tube(8, 3), {{"front", VertexPath{{0}}}}, {}), "needs two vertices"));
    }
}

}  // namespace lastflat
