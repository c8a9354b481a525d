#include "core/numerics/geometry.h"

#include <doctest/doctest.h>

#include <numbers>

namespace lastflat {

using std::numbers::pi;

TEST_SUITE("core/numerics/geometry") {
    TEST_CASE("a triangle's area vector points to where it is counter-clockwise from") {
        const Triangulation surface{{{0, 0, 1}, {4, 0, 1}, {0, 3, 1}}, {{0, 1, 2}}};
        CHECK(doubled_area_vector(surface, {0, 1, 2}) == Vec3(0, 0, 12));
        CHECK(doubled_area_vector(surface, {0, 2, 1}) == Vec3(0, 0, -12));
        CHECK(centroid(surface, {0, 1, 2}).isApprox(Vec3(4.0 / 3.0, 1, 1)));
    }

    TEST_CASE("signed angles turn counter-clockwise, others have no sign") {
        CHECK(signed_angle({1, 0}, {0, 2}) == doctest::Approx(pi / 2));
        CHECK(signed_angle({0, 2}, {1, 0}) == doctest::Approx(-pi / 2));
        CHECK(angle_between({0, 2, 0}, {1, 0, 0}) == doctest::Approx(pi / 2));
        CHECK(angle_between({1, 0, 0}, {-3, 0, 0}) == doctest::Approx(pi));
        CHECK(angle_at<Vec2>({1, 1}, {2, 1}, {1, 5}) == doctest::Approx(pi / 2));
    }

    TEST_CASE("the nearest point of a segment is one of its ends beyond them") {
        const Vec3 from(1, 0, 0), to(5, 0, 0);
        CHECK(nearest_share(from, to, {2, 7, 0}) == 0.25);
        CHECK(nearest_share(from, to, {0, 7, 0}) == 0.0);
        CHECK(nearest_share(from, to, {9, 0, 7}) == 1.0);
        CHECK(nearest_share(from, from, {9, 0, 7}) == 0.0);
    }

    TEST_CASE("a triangle that is laid flat keeps its sides") {
        const Vec3 a(1, 2, 3), b(4, 6, 3), c(1, 2, 5);
        const FlatTriangle flat = laid_flat(a, b, c);
        CHECK(flat.length == doctest::Approx(5.0));
        CHECK(flat.apex.norm() == doctest::Approx((c - a).norm()));
        CHECK((flat.apex - Vec2(flat.length, 0)).norm() == doctest::Approx((c - b).norm()));
        CHECK(flat.apex.y() > 0.0);
        CHECK(flat.angle() == doctest::Approx(pi / 2));
    }

    TEST_CASE("the inverse of a list says where each number stands in it") {
        CHECK(inverse({4, 0, 2}, 6) == std::vector<Index>{1, -1, 2, -1, 0, -1});
    }
}

}  // namespace lastflat
