#include <doctest/doctest.h>

#include <Eigen/LU>
#include <cmath>

#include "core/error.h"
#include "core/numerics/polygon.h"
#include "core/numerics/singular_values.h"

namespace lastflat {

TEST_SUITE("core/numerics/singular_values") {
    TEST_CASE("rotation and reflection multiply to the matrix, the stretches to its determinant") {
        for (int k = 0; k < 60; ++k) {
            Eigen::Matrix2d F;
            F << std::sin(1.0 * k), std::cos(2.3 * k), std::sin(3.1 * k + 1), std::cos(0.7 * k);
            const StretchFrame frame = stretch_frame(F);
            Eigen::Matrix2d A, B;
            A << frame.rotation.x(), -frame.rotation.y(), frame.rotation.y(), frame.rotation.x();
            B << frame.reflection.x(), frame.reflection.y(), frame.reflection.y(),
                -frame.reflection.x();
            CHECK((frame.q * A + frame.r * B - F).norm() < 1e-14);
            CHECK(frame.rotation.norm() == doctest::Approx(1.0));
            CHECK(frame.reflection.norm() == doctest::Approx(1.0));
            CHECK(frame.larger() >= std::abs(frame.smaller()));
            CHECK(frame.larger() * frame.smaller() == doctest::Approx(F.determinant()));
        }
    }
}

TEST_SUITE("core/numerics/polygon") {
    TEST_CASE("the hull of points with collinear ones keeps strict corners only") {
        const Points2 points{{0, 0}, {1, 0}, {2, 0}, {2, 2}, {1, 1}, {0, 2}, {0, 1}};
        CHECK(convex_hull(points) == std::vector<Index>{0, 2, 3, 5});
    }

    TEST_CASE("crossings are found, neighbours are none") {
        CHECK(self_crossings({{0, 0}, {4, 0}, {4, 4}, {0, 4}}).empty());
        const auto bow = self_crossings({{0, 0}, {4, 4}, {4, 0}, {0, 4}});
        REQUIRE(bow.size() == 1);
        CHECK(bow[0].a == 0);
        CHECK(bow[0].b == 2);
    }

    TEST_CASE("a border that touches itself along a line counts as crossing") {
        CHECK_FALSE(self_crossings({{0, 0}, {6, 0}, {6, 3}, {4, 3}, {4, 0}, {2, 0}, {2, 3}, {0, 3}})
                        .empty());
    }

    TEST_CASE("the angle of a needle keeps its digits") {
        const double tiny = 1e-9;
        CHECK(angle_at(Vec2(0, 0), Vec2(1, 0), Vec2(1, tiny)) ==
              doctest::Approx(tiny).epsilon(1e-6));
    }
}

}  // namespace lastflat
