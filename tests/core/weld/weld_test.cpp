#include "core/weld/weld.h"

#include <doctest/doctest.h>

#include "core/load/load_model.h"
#include "core/weld/merge_vertices.h"
#include "tests/helpers/errors.h"

namespace lastflat {
namespace {

using test::has;

std::string weld_error(const std::string& obj, const WeldOptions& options = {}) {
    return test::error_of([&] { (void)weld(load_model(obj), options); });
}

const std::string tetrahedron =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

double volume(const SurfaceMesh& surface) {
    double sum = 0;
    for (const auto face : surface.mesh.faces()) {
        std::vector<Vec3> p;
        for (const auto v : surface.mesh.fv_range(face)) p.push_back(surface.position(v.idx()));
        sum += p[0].dot(Vec3(p[1].y() * p[2].z() - p[1].z() * p[2].y(),
                             p[1].z() * p[2].x() - p[1].x() * p[2].z(),
                             p[1].x() * p[2].y() - p[1].y() * p[2].x())) /
               6;
    }
    return sum;
}

}  // namespace

TEST_SUITE("core/weld") {
    TEST_CASE("vertices within the tolerance are merged whichever way they lie") {
        constexpr double tolerance = 0.1;
        Points3 positions;
        std::size_t pairs = 0;
        for (int i = -3; i <= 3; ++i) {
            for (int j = -3; j <= 3; ++j) {
                for (int k = -3; k <= 3; ++k) {
                    if (i == 0 && j == 0 && k == 0) continue;
                    const Vec3 way = Vec3(i, j, k).normalized();
                    for (const double share : {0.5, 0.999, 1.001}) {  // the last stays apart
                        const Vec3 at(static_cast<double>(pairs++), 0.03 * i, 0.01 * j);
                        positions.push_back(at);
                        positions.push_back(at + share * tolerance * way);
                    }
                }
            }
        }
        const auto merged = merge_vertices(positions, tolerance);
        for (std::size_t p = 0; p < pairs; ++p) {
            CAPTURE(p);
            const bool is_near = p % 3 != 2;
            CHECK((merged[2 * p] == merged[2 * p + 1]) == is_near);
            CHECK(merged[2 * p] == static_cast<Index>(2 * p));
        }
    }

    TEST_CASE("what is not a surface is refused with its place") {
        CHECK(has(
            weld_error("v 0 0 0\nv 0 0 2\nv 1 0 0\nv 0 1 0\nv -1 0 0\nf 1 2 3\nf 2 1 4\nf 1 2 5\n"),
            "mesh_not_manifold: edge shared by 3 faces at 0.0 0.0 1.0"));
        CHECK(has(weld_error("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"),
                  "mesh_degenerate: no face is left"));
    }

    TEST_CASE("a missing group is named, with those that there are") {
        WeldOptions options;
        options.groups = {"uper"};
        CHECK(has(weld_error("v 0 0 0\nv 1 0 0\nv 0 1 0\ng upper\nf 1 2 3\n", options),
                  "group_not_found /surface/groups/0: group 'uper' does not exist: the model has "
                  "'upper'"));
    }

    TEST_CASE("a closed model inside out is turned, and it is said") {
        std::string inside_out = tetrahedron;
        for (const auto& [a, b] :
             {std::pair("f 1 3 2", "f 1 2 3"), std::pair("f 1 2 4", "f 1 4 2"),
              std::pair("f 2 3 4", "f 2 4 3"), std::pair("f 1 4 3", "f 1 3 4")}) {
            inside_out.replace(inside_out.find(a), 7, b);
        }
        const SurfaceMesh good = weld(load_model(tetrahedron)),
                          turned = weld(load_model(inside_out));
        CHECK(good.repairs.empty());
        REQUIRE(turned.repairs.size() == 1);
        CHECK(turned.repairs[0].code == "orientation_reversed");
        CHECK(volume(good) == doctest::Approx(1.0 / 6));
        CHECK(volume(turned) == doctest::Approx(1.0 / 6));
    }

    TEST_CASE("indexed vertices of one place stay apart unless asked") {
        const std::string slit =
            "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 4 5 6\n";
        CHECK(weld(load_model(slit)).welded_to == std::vector<Index>{0, 1, 2, 3, 4, 5});
        WeldOptions options;
        options.tolerance_mm = 0.001;
        CHECK(weld(load_model(slit), options).welded_to == std::vector<Index>{0, 1, 2, 0, 2, 5});
    }

    TEST_CASE("without indices, vertices of one place are one vertex") {
        RawMesh raw =
            load_model("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 4 5 6\n");
        raw.indexed = false;
        CHECK(weld(raw).welded_to == std::vector<Index>{0, 1, 2, 0, 2, 5});
    }

    TEST_CASE("the unit scales to millimetres") {
        WeldOptions options;
        options.unit_mm = 25.4;
        CHECK(weld(load_model(tetrahedron), options).position(1).x() == doctest::Approx(25.4));
    }
}

}  // namespace lastflat
