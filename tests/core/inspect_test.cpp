#include "core/inspect.h"

#include <doctest/doctest.h>

#include "tests/helpers/errors.h"
#include "tests/helpers/sample.h"
#include "tests/helpers/sheets.h"

namespace lastflat {

TEST_SUITE("core/inspect") {
    TEST_CASE("a square is open, has one border and flattens") {
        const Inspection found =
            inspect("g a\nv 0 0 0\nv 10 0 0\nv 10 20 0\nv 0 20 0\nv 9 9 9\nf 1 2 3\nf 1 3 4\n", {});
        CHECK(found.file_vertices == 5);
        CHECK(found.vertices == 4);
        CHECK(found.triangles == 2);
        CHECK(found.components == 1);
        CHECK(found.area_mm2 == doctest::Approx(200.0));
        REQUIRE(found.border_loops.size() == 1);
        CHECK(found.border_loops[0].length_mm == doctest::Approx(60.0));
        CHECK(found.size_mm.y() == doctest::Approx(20.0));
        CHECK(found.groups == std::vector<NamedFaces>{{{"a"}, 2}});
        CHECK_FALSE(found.fault.has_value());
        REQUIRE(found.regions.size() == 1);
        CHECK(found.regions[0].border_mm == doctest::Approx(60.0));
    }

    TEST_CASE("a closed surface is described, and why it does not flatten") {
        const Inspection found =
            inspect("v 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n", {});
        CHECK(found.border_loops.empty());
        REQUIRE(found.fault.has_value());
        CHECK(found.fault->code() == ErrorCode::region_invalid);
        CHECK(found.regions.empty());
    }

    TEST_CASE("two pieces are two components") {
        const Inspection found = inspect(
            "v 0 0 0\nv 9 0 0\nv 0 9 0\nv 20 0 0\nv 29 0 0\nv 20 9 0\nf 1 2 3\nf 4 5 6\n", {});
        CHECK(found.components == 2);
        CHECK(found.border_loops.size() == 2);
    }

    TEST_CASE("the sample last is what it is made as") {
        const SampleLast last = make_sample_last();
        const Inspection found = inspect(write_model_obj(last.mesh), test::sample_options(last));
        CHECK(found.regions.size() == 2);
        CHECK(found.border_loops.size() == 2);  // topline and featherline
        CHECK_FALSE(found.fault.has_value());
    }

    TEST_CASE("holes are told with their place and what they stand for") {
        FlattenOptions open, keep;
        open.request.weld.unit_mm = keep.request.weld.unit_mm = 1.0;
        keep.request.cut.holes = HoleRule::keep;
        const std::string tube = test::tube_obj(12, 2);
        const Inspection kept = inspect(tube, keep), opened = inspect(tube, open);
        REQUIRE(kept.regions.at(0).holes.size() == 1);
        CHECK(kept.regions[0].holes[0].curvature == doctest::Approx(2 * M_PI));
        CHECK(kept.regions[0].holes[0].length_mm == doctest::Approx(24 * std::sin(M_PI / 12)));
        CHECK(kept.warnings.empty());
        CHECK(opened.regions.at(0).holes.empty());
        REQUIRE(opened.warnings.size() == 1);
        CHECK(opened.warnings[0].code == "seam_added");
    }

    TEST_CASE("every face is counted once, whatever names it bears") {
        const std::string square = "v 0 0 0\nv 9 0 0\nv 9 9 0\nv 0 9 0\n";
        const Inspection twice = inspect(square + "g a\no a\nf 1 2 3\n", {});
        CHECK(twice.groups == std::vector<NamedFaces>{{{"a"}, 1}});
        const Inspection shared = inspect(square + "f 1 2 3\ng b a\nf 1 3 4\ng a\nf 2 1 3 4\n", {});
        CHECK(shared.groups == std::vector<NamedFaces>{{{}, 1}, {{"a"}, 2}, {{"a", "b"}, 1}});
        CHECK(shared.file_triangles == 4);
    }

    TEST_CASE("vertices that are not shared in the file count after welding") {
        std::string stl = "solid square\n";
        for (const char* corners :
             {"vertex 0 0 0 vertex 9 0 0 vertex 9 9 0", "vertex 0 0 0 vertex 9 9 0 vertex 0 9 0"})
            stl += std::string("facet normal 0 0 1\nouter loop ") + corners + " endloop endfacet\n";
        FlattenOptions options;
        options.limits.vertices = 4;
        CHECK(inspect(stl, options).vertices == 4);
        options.limits.vertices = 3;
        CHECK(test::has(test::error_of([&] { (void)inspect(stl, options); }),
                        "model_too_large: 4 vertices after welding; at most 3"));
    }

    TEST_CASE("what the reader passed over is among the warnings") {
        const std::string square =
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
            "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
            "end_header\n0 0 0\n200 0 0\n0 99 0\n3 0 1 2\n";
        CHECK(inspect(square, {}).warnings.empty());
        const Inspection found = inspect(square + "3 0 2 1\n", {});
        REQUIRE(found.warnings.size() == 1);
        CHECK(found.warnings[0].code == "trailing_bytes");
    }

    TEST_CASE("what is no surface is an error") {
        CHECK_THROWS_AS((void)inspect("hello", {}), Error);
        CHECK_THROWS_AS((void)inspect("v 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\nv 0 0 -9\n"
                                      "f 1 2 3\nf 1 2 4\nf 1 2 5\n",
                                      {}),
                        Error);
    }
}

}  // namespace lastflat
