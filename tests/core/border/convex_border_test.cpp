#include "core/border/convex_border.h"

#include <doctest/doctest.h>

#include "core/numerics/polygon.h"
#include "tests/helpers/shapes.h"

namespace lastflat {
namespace {

double perimeter(const Points2& polygon) {
    double sum = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i)
        sum += (polygon[(i + 1) % polygon.size()] - polygon[i]).norm();
    return sum;
}

/// The least doubled area of three successive corners: not negative for a convex polygon.
double least_turn(const Points2& polygon) {
    double least = 1e300;
    const std::size_t n = polygon.size();
    for (std::size_t i = 0; i < n; ++i) {
        least =
            std::min(least, doubled_area(polygon[i], polygon[(i + 1) % n], polygon[(i + 2) % n]));
    }
    return least;
}

}  // namespace

TEST_SUITE("core/border/convex_border") {
    TEST_CASE("a circle is strictly convex, counter-clockwise, and about as long as the border") {
        const Region region = test::saddle();
        const Points2 circle = circle_border(region);
        double length = 0;
        for (const double edge : border_lengths(region)) length += edge;
        CHECK(least_turn(circle) > 0);
        CHECK(perimeter(circle) == doctest::Approx(length).epsilon(0.01));
    }

    TEST_CASE("a square puts its corners at the sharp corners of the region") {
        const Region region =
            test::grid(10, 10, [](double s, double t) { return Vec3(50 * s, 50 * t, 0); });
        const Points2 square = square_border(region);
        CHECK(signed_area(square) == doctest::Approx(2500.0).epsilon(1e-12));
        for (std::size_t i = 0; i < square.size(); ++i) {
            const Index v = region.border[i];
            if (v != 0 && v != 10 && v != 110 && v != 120) continue;
            CHECK(std::abs(std::abs(square[i].x() - 25) - 25) < 1e-9);
            CHECK(std::abs(std::abs(square[i].y() - 25) - 25) < 1e-9);
        }
    }

    TEST_CASE("the hull keeps its corners and takes the others in order") {
        const Points2 notched{{0, 0}, {4, 0}, {4, 4}, {2, 1}, {0, 4}};
        const Points2 hull = hull_border(notched);
        CHECK(hull[0] == Vec2(0, 0));
        CHECK((hull[3] - Vec2(2, 4)).norm() < 1e-12);
        CHECK(least_turn(hull) > -1e-12);
    }

    TEST_CASE("the virtual layer lies at its distance from every edge and stays convex") {
        const Points2 polygon{{0, 0}, {2, 0}, {4, 0}, {5, 3}, {1, 4}};
        const Points2 layer = virtual_layer(polygon, 0.5);
        CHECK(least_turn(layer) > -1e-12);
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const Vec2 along = (polygon[(i + 1) % 5] - polygon[i]).normalized();
            CHECK(cross(along, layer[i] - polygon[i]) == doctest::Approx(-0.5));
        }
    }
}

}  // namespace lastflat
