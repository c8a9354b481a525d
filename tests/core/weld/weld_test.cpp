#include "core/weld/weld.h"

#include <doctest/doctest.h>

#include "core/load/load_model.h"
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
