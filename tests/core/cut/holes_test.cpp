#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "core/cut/cut.h"
#include "core/cut/find_border.h"
#include "core/cut/seam_stretches.h"
#include "core/load/load_model.h"
#include "core/numerics/polygon.h"
#include "core/parameterize/fill_holes.h"
#include "core/prepare.h"
#include "core/weld/weld.h"
#include "tests/helpers/regions.h"
#include "tests/helpers/sheets.h"

namespace lastflat {
namespace {

using test::cut;

using std::numbers::pi;

std::string ring() {
    return test::sheet_obj(6, 6, test::flat,
                           [](int i, int j) { return i >= 2 && i < 4 && j >= 1 && j < 3; });
}

/// The signed area that a loop of a region in the plane z = 0 spans.
double area_of(const Region& region, const std::vector<Index>& loop) {
    Points2 polygon;
    for (const Index v : loop) polygon.push_back(region.position(v).head<2>());
    return signed_area(polygon);
}

std::vector<HoleSeam> seams(const Region& region, HoleRule rule, bool is_first = true) {
    return seams_of_next_hole(region, rule, is_first, Progress());
}

bool on_loop(const std::vector<Index>& loop, const SurfacePoint& point) {
    return std::find(loop.begin(), loop.end(), point.vertex()) != loop.end();
}

}  // namespace

TEST_SUITE("core/cut/find_border") {
    TEST_CASE("the outer loop goes counter-clockwise, a hole clockwise") {
        const auto regions = cut(ring());
        REQUIRE(regions.size() == 1);
        REQUIRE(regions[0].holes.size() == 1);
        CHECK(area_of(regions[0], regions[0].border) == doctest::Approx(3600.0));
        CHECK(area_of(regions[0], regions[0].holes[0]) == doctest::Approx(-400.0));
        CHECK(border_loops(regions[0]).size() == 2);
    }

    TEST_CASE("of a tube that opens upwards the wide end is the outer loop") {
        const auto regions = cut(test::tube_obj(12, 2, [](double angle, int j) {
            return Vec3((10 + 5 * j) * std::cos(angle), (10 + 5 * j) * std::sin(angle), 10.0 * j);
        }));
        for (const Index v : regions[0].border) CHECK(regions[0].position(v).z() == 20.0);
    }
}

TEST_SUITE("core/cut/seam_stretches") {
    TEST_CASE("a seam between two regions that another one ends on is two stretches") {
        //  +---+---+
        //  |   | b |   the seam `mid` has one run on its left and two on its right
        //  | a +---+
        //  |   | c |
        //  +---+---+
        const CurveSource mid{"mid", VertexPath{{2, 7, 12, 17, 22}}},
            side{"side", VertexPath{{12, 13, 14}}};
        const auto regions = cut(test::sheet_obj(4, 4, test::flat), {mid, side},
                                 {{"mid", "side"}, {{"a", 5}, {"b", 19}, {"c", 9}}});
        std::vector<const Region*> all;
        for (const Region& region : regions) all.push_back(&region);
        const auto stretches = seam_stretches(all, "mid");
        REQUIRE(stretches.size() == 2);
        for (const SeamStretch& both : stretches) {
            CHECK(both.a.region == 0);
            REQUIRE(both.a.vertices.size() == 3);
            REQUIRE(both.b.vertices.size() == 3);
            for (std::size_t i = 0; i < 3; ++i) {
                const auto a = static_cast<std::size_t>(both.a.vertices[i]);
                const auto b = static_cast<std::size_t>(both.b.vertices[i]);
                CHECK(regions[0].source_vertices[a] == regions[both.b.region].source_vertices[b]);
            }
        }
        CHECK(stretches[0].b.region != stretches[1].b.region);
        CHECK(seam_stretches(all, "side").size() == 1);
        CHECK(seam_stretches({&regions[0]}, "mid").empty());  // its other side is not there
    }

    TEST_CASE("a slit is one stretch between the two sides of one region") {
        const auto regions = cut(test::sheet_obj(4, 4, test::flat),
                                 {{"slit", VertexPath{{6, 7, 12}}}}, {{"slit"}, {}});
        REQUIRE(regions.size() == 1);
        const auto stretches = seam_stretches({&regions[0]}, "slit");
        REQUIRE(stretches.size() == 1);
        CHECK(stretches[0].a.vertices.front() == stretches[0].b.vertices.front());
        CHECK(stretches[0].a.vertices[1] != stretches[0].b.vertices[1]);
        CHECK(stretches[0].a.vertices.back() == stretches[0].b.vertices.back());
    }
}

TEST_SUITE("core/cut/open_holes") {
    TEST_CASE("a hole in a plane stands for no curvature, the end of a tube for a full turn") {
        const auto flat = cut(ring()), tube = cut(test::tube_obj(12, 2));
        CHECK(hole_curvatures(flat[0])[0] == doctest::Approx(0.0));
        CHECK(hole_curvatures(tube[0])[0] == doctest::Approx(2 * pi));
    }

    TEST_CASE("a pyramid without its tip stands for the tip's curvature") {
        const auto regions =
            cut("v -9 -9 0\nv 9 -9 0\nv 9 9 0\nv -9 9 0\nv -3 -3 6\nv 3 -3 6\nv 3 3 6\nv -3 3 6\n"
                "f 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
        // Whole, its tip (0, 0, 9) would have four angles between (1, 1, -1) and (-1, 1, -1).
        CHECK(hole_curvatures(regions[0])[0] == doctest::Approx(2 * pi - 4 * std::acos(1.0 / 3.0)));
    }

    TEST_CASE("a hole in a plane is kept, the end of a tube is opened straight across") {
        const auto flat = cut(ring()), tube = cut(test::tube_obj(8, 3));
        CHECK(seams(flat[0], HoleRule::automatic).empty());
        CHECK(seams(tube[0], HoleRule::keep).empty());
        const auto opened = seams(tube[0], HoleRule::automatic);
        REQUIRE(opened.size() == 1);
        CHECK(opened[0].curve.empty());
        CHECK(opened[0].length == doctest::Approx(3.0));
        CHECK(opened[0].curvature == doctest::Approx(2 * pi));
        const auto &first = opened[0].points.front(), &last = opened[0].points.back();
        CHECK(on_loop(tube[0].border, first) != on_loop(tube[0].border, last));
        CHECK(on_loop(tube[0].holes[0], first) != on_loop(tube[0].holes[0], last));
    }

    TEST_CASE("if holes are to be opened, the shortest way is taken") {
        const auto opened = seams(cut(ring())[0], HoleRule::open);
        REQUIRE(opened.size() == 1);
        CHECK(opened[0].length == doctest::Approx(10.0));  // one cell from the lower border
    }

    TEST_CASE("a slit is never opened") {
        const auto regions = cut(test::sheet_obj(4, 4, test::flat),
                                 {{"slit", VertexPath{{6, 7, 12}}}}, {{"slit"}, {}});
        REQUIRE(regions[0].holes.size() == 1);
        CHECK(is_slit(regions[0], regions[0].holes[0]));
        CHECK_FALSE(is_slit(regions[0], regions[0].border));
        CHECK(seams(regions[0], HoleRule::open).empty());
    }

    /// An upper: a long outer loop, and a small top nearer to the end at x = -40.
    const std::string upper = test::tube_obj(24, 4, [](double angle, int j) {
        const double shrink = 1.0 - 0.15 * j;
        return Vec3(-4.0 * j + 40 * shrink * std::cos(angle), (15 - 0.3 * j) * std::sin(angle),
                    8 * j);
    });

    TEST_CASE("a long piece is opened at the end where its hole is") {
        const auto regions = cut(upper);
        const auto opened = seams(regions[0], HoleRule::automatic);
        REQUIRE(opened.size() == 1);
        CHECK(opened[0].points.front().vertex() == 12);  // at x = -40
        CHECK(opened[0].points.back().vertex() == 4 * 24 + 12);
        // A shorter way leads up the side, which any further hole would take.
        const auto second = seams(regions[0], HoleRule::automatic, false);
        REQUIRE(second.size() == 1);
        CHECK(second[0].length < opened[0].length);
    }

    TEST_CASE("the hole that is opened first is opened at the heel, whatever else is sewn") {
        Request request;
        request.weld.unit_mm = 1.0;
        request.curves = {{"seam_1", VertexPath{{24 + 2, 48 + 2, 72 + 2}}}};
        request.cut.seams = {"seam_1"};
        SurfaceMesh surface = weld(load_model(upper), request.weld);
        const CutSurface cut = cut_surface(surface, make_plan(surface, request), Progress());
        REQUIRE(cut.seams.size() == 2);
        CHECK(cut.seams[1] == "seam_2");  // another name than the curve's
        CHECK(cut.inserted.curves.back().vertices.front() == 12);
        CHECK(cut.warnings.size() == 1);
    }

    TEST_CASE("a heel curve that joins two loops is where the piece is opened") {
        const CurveSource inner{"heel", VertexPath{{1, 25, 49, 73}}},
            whole{"heel", VertexPath{{1, 25, 49, 73, 97}}};
        const auto opened = seams(cut(upper, {whole})[0], HoleRule::automatic);
        REQUIRE(opened.size() == 1);
        CHECK(opened[0].curve == "heel");
        CHECK(seams(cut(upper, {inner})[0], HoleRule::automatic)[0].curve.empty());
    }
}

TEST_SUITE("core/parameterize/fill_holes") {
    TEST_CASE("every hole, also a slit in a plane, is closed by triangles that have an area") {
        const auto slit = cut(test::sheet_obj(4, 4, test::flat), {{"slit", VertexPath{{6, 7, 8}}}},
                              {{"slit"}, {}});
        for (const Region& region : {cut(ring())[0], slit[0]}) {
            const Region disk = with_holes_filled(region);
            CHECK(disk.positions.size() == region.positions.size() + 1);
            REQUIRE(disk.triangles.size() == region.triangles.size() + region.holes[0].size());
            for (const Triangle& t : disk.triangles) {
                const Vec3 a = disk.position(t[1]) - disk.position(t[0]);
                const Vec3 b = disk.position(t[2]) - disk.position(t[0]);
                CHECK(a.cross(b).norm() > 1.0);
            }
            Region found = disk;
            find_border(found);
            CHECK(found.holes.empty());
            CHECK(found.border == region.border);
        }
    }
}

TEST_SUITE("core/cut/insert_curves") {
    TEST_CASE("curves that come later keep the earlier ones, and the way back to old vertices") {
        SurfaceMesh surface = weld(load_model(test::sheet_obj(4, 4, test::bent)));
        const auto old_vertices = surface.mesh.n_vertices();
        const SurfaceMesh before = surface;
        const auto line = [&](const std::string& name, Index from, Index to) {
            const CurveSource source{name, ShortestPath{{"from", "to"}}};
            return locate_curves(surface, {source}, {{"from", from}, {"to", to}}).front();
        };
        InsertedCurves inserted =
            insert_curves(surface, {line("first", 5, 14), line("other", 15, 24)});
        const auto length_of_first = [&] {
            double sum = 0;
            const auto& v = inserted.curves[0].vertices;
            for (std::size_t i = 1; i < v.size(); ++i)
                sum += (surface.position(v[i]) - surface.position(v[i - 1])).norm();
            return sum;
        };
        const double length = length_of_first();
        inserted = insert_more_curves(surface, std::move(inserted), {line("across", 1, 23)});
        REQUIRE(inserted.curves.size() == 3);
        CHECK(inserted.curves[2].name == "across");
        CHECK(length_of_first() == doctest::Approx(length).epsilon(1e-12));
        REQUIRE(surface.mesh.n_vertices() == old_vertices + inserted.added.size());
        for (std::size_t i = 0; i < inserted.added.size(); ++i) {
            for (const Index corner : inserted.added[i].support())
                CHECK(corner < static_cast<Index>(old_vertices));
            CHECK((position_of(before, inserted.added[i]) -
                   surface.position(static_cast<Index>(old_vertices + i)))
                      .norm() < 1e-9);
        }
    }
}

}  // namespace lastflat
