#include "core/export/super_level.h"

#include <doctest/doctest.h>

#include "core/numerics/geometry.h"
#include "tests/helpers/regions.h"
#include "tests/helpers/shapes.h"
#include "tests/helpers/sheets.h"

namespace lastflat {
namespace {

Points2 seen_from_above(const Region& region) {
    Points2 points;
    for (const Vec3& p : region.positions) points.emplace_back(p.x(), p.y());
    return points;
}

/// Left of the loops.
double area_of(const std::vector<Points2>& loops) {
    double area = 0.0;
    for (const Points2& loop : loops) {
        for (std::size_t i = 0; i < loop.size(); ++i)
            area += 0.5 * cross(loop[i], loop[(i + 1) % loop.size()]);
    }
    return area;
}

Region square() {
    return test::grid(8, 8, [](double s, double t) { return Vec3(10 * s, 10 * t, 0); });
}

template <class Function>
std::vector<double> values_of(const Region& region, const Function& f) {
    std::vector<double> values;
    for (const Vec3& p : region.positions) values.push_back(f(p));
    return values;
}

}  // namespace

TEST_SUITE("core/export/super_level") {
    TEST_CASE("of a linear function it is exactly the half-plane") {
        const Region region = square();
        const auto values = values_of(region, [](const Vec3& p) { return p.x() + 0.3 * p.y(); });
        // x + 0.3 y >= 4 leaves the trapezium with widths 6 and 9.
        const auto loops = super_level_loops(region, seen_from_above(region), values, 4.0);
        CHECK(loops.size() == 1);
        CHECK(area_of(loops) == doctest::Approx(75.0));
        CHECK(super_level_loops(region, seen_from_above(region), values, 13.5).empty());
        CHECK(area_of(super_level_loops(region, seen_from_above(region), values, -1.0)) ==
              doctest::Approx(100.0));
    }

    TEST_CASE("what is above and what is below fill the piece, around its holes, too") {
        const Region region = test::cut(test::sheet_obj(9, 9, test::flat, [](int i, int j) {
                                  return i > 2 && i < 6 && j > 2 && j < 6;
                              })).front();
        REQUIRE(region.holes.size() == 1);
        const auto values = values_of(
            region, [](const Vec3& p) { return std::sin(0.09 * p.x()) * std::cos(0.07 * p.y()); });
        std::vector<double> negative = values;
        for (double& value : negative) value = -value;
        const double whole = surface_area(region);
        for (const double level : {-0.6, -0.1, 0.0, 0.2, 0.7}) {
            CAPTURE(level);
            const double above =
                area_of(super_level_loops(region, seen_from_above(region), values, level));
            const double below =
                area_of(super_level_loops(region, seen_from_above(region), negative, -level));
            CHECK(above > 0.0);
            CHECK(above < whole);
            CHECK(above + below == doctest::Approx(whole));
        }
    }

    TEST_CASE("an island is a loop of its own, a lake in it turns the other way") {
        const Region region = square();
        const auto values = values_of(
            region, [](const Vec3& p) { return -std::abs((p - Vec3(5, 5, 0)).norm() - 3.0); });
        const auto ring = super_level_loops(region, seen_from_above(region), values, -0.8);
        REQUIRE(ring.size() == 2);
        CHECK(area_of({ring[0]}) * area_of({ring[1]}) < 0.0);
    }
}

}  // namespace lastflat
