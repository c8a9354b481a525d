#include <doctest/doctest.h>

#include "core/load/load_model.h"
#include "core/load/triangulate_polygon.h"
#include "tests/helpers/errors.h"

namespace lastflat {
namespace {

using test::has;
using test::load_error;

}  // namespace

TEST_SUITE("core/load/read_obj") {
    TEST_CASE("byte order mark, CRLF, tabs, comments, continuation and relative indices are read") {
        const RawMesh mesh = load_model(
            "\xEF\xBB\xBF# a comment\r\nv 0 0 0\r\nv\t1 0 0 1.0\r\nv 1 1 +0.5e0\r\nvn 0 0 1\r\n"
            "f -3//1 -2//1 \\\r\n -1//1\r\n");
        CHECK(mesh.positions.size() == 3);
        CHECK(mesh.positions[2] == Vec3(1, 1, 0.5));
        REQUIRE(mesh.triangles.size() == 1);
        CHECK(mesh.triangles[0] == Triangle{0, 1, 2});
        CHECK(mesh.default_unit_mm == 1.0);
        CHECK(mesh.indexed);
    }

    TEST_CASE("lines may end with CR alone, and are counted") {
        const RawMesh mesh =
            load_model("# scan\rv 0 0 0\rv 1 0 0\rv 0 1 0\rg upper\rf 1 2 \\\r3\r");
        CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, 2}});
        CHECK(mesh.label_sets[0] == std::vector<std::string>{"upper"});
        CHECK(has(load_error("v 0 0 0\r\rv 0 0 x\r"), "line 3: 'x' is not a number"));
        CHECK(has(load_error("v 0 0 0\r\n\r\nv 0 0 x\r\n"), "line 3: 'x' is not a number"));
    }

    TEST_CASE("names that are no UTF-8 are Latin-1") {
        const RawMesh mesh = load_model(
            "v 0 0 0\nv 1 0 0\nv 0 1 0\ng au\xdf"
            "en\no \xe9t\xe9\nusemtl cuir\nf 1 2 3\n"
            "g au\xc3\x9f"
            "en\nf 1 3 2\n");
        REQUIRE(mesh.label_sets.size() == 1);
        CHECK(mesh.label_sets[0] == std::vector<std::string>{"au\xc3\x9f"
                                                             "en",
                                                             "\xc3\xa9t\xc3\xa9", "cuir"});
    }

    TEST_CASE("groups, objects and materials are the names of a face") {
        const RawMesh mesh = load_model(
            "v 0 0 0\nv 1 0 0\nv 0 1 0\no last one\ng upper left\nusemtl calf skin\nf 1 2 3\ng "
            "sole\nf 1 3 2\n");
        REQUIRE(mesh.label_sets.size() == 2);
        CHECK(mesh.label_sets[mesh.triangle_labels[0]] ==
              std::vector<std::string>{"upper", "left", "last one", "calf skin"});
        CHECK(mesh.label_sets[mesh.triangle_labels[1]] ==
              std::vector<std::string>{"sole", "last one", "calf skin"});
    }

    TEST_CASE("a concave polygon keeps its area") {
        const Points3 points{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 1, 0}, {0, 4, 0}};
        const std::vector<Index> corners{0, 1, 2, 3, 4};
        double area = 0;
        for (const Triangle& t : triangulate_polygon(points, corners)) {
            const Vec3 a =
                points[static_cast<std::size_t>(t[1])] - points[static_cast<std::size_t>(t[0])];
            const Vec3 b =
                points[static_cast<std::size_t>(t[2])] - points[static_cast<std::size_t>(t[0])];
            const double doubled = a.x() * b.y() - a.y() * b.x();
            CHECK(doubled > 0);
            area += doubled / 2;
        }
        CHECK(area == doctest::Approx(10.0));
    }

    TEST_CASE("a quad is cut along its shorter diagonal") {
        const Points3 points{{0, 0, 0}, {10, 0, 0}, {11, 1, 0}, {1, 1, 0}};
        const std::vector<Index> corners{0, 1, 2, 3};
        for (const Triangle& t : triangulate_polygon(points, corners)) {
            CHECK(std::count(t.begin(), t.end(), 0) + std::count(t.begin(), t.end(), 2) == 1);
        }
    }

    TEST_CASE("what is wrong is named with its line") {
        CHECK(has(load_error("v 0 0 0\nf 1 2 3\n"), "line 2: vertex 2 does not exist"));
        CHECK(has(load_error("v 0 0 0\nf 0 1 1\n"), "line 2: vertex 0 does not exist"));
        CHECK(has(load_error("v 0 0\n"), "line 1: a vertex needs three coordinates"));
        CHECK(has(load_error("v 0 0 x\n"), "line 1: 'x' is not a number"));
        CHECK(has(load_error("v 0 0 nan\n"), "not finite"));
        CHECK(has(load_error("v 0 0 0\nf 1 1\n"), "a face needs three vertices"));
        CHECK(has(load_error("hello\n"), "no vertex"));
        CHECK(has(load_error("v 0 0 0\np 1\n"), "no face"));
        CHECK(has(load_error("call other.obj\n"), "unsupported_model"));
        CHECK(has(load_error(""), "0 bytes"));
    }

    TEST_CASE("limits are errors of their own") {
        LoadLimits limits;
        limits.vertices = 2;
        CHECK(has(load_error("v 0 0 0\nv 0 0 0\nv 0 0 0\n", limits), "model_too_large"));
        limits = {};
        limits.polygon_corners = 3;
        CHECK(has(load_error("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n", limits),
                  "model_too_large"));
    }

    TEST_CASE("formats that are not read are named") {
        CHECK(has(load_error("solid last\nfacet"), "STL"));
        CHECK(has(load_error("ply\nformat ascii 1.0\n"), "PLY"));
        CHECK(has(load_error(std::string_view("\xFF\xFEv\0", 4)), "UTF-16"));
    }
}

}  // namespace lastflat
