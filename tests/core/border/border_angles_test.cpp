#include "core/border/border_angles.h"

#include <doctest/doctest.h>

#include <numbers>
#include <numeric>

#include "tests/helpers/shapes.h"

namespace lastflat {
namespace {

BorderAngles angles_of(const Region& region, AngleRule rule) {
    return border_angles(region, dissection_of(region.positions, region.half_edges), rule);
}

using std::numbers::pi;

double sum(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

/// The exterior angles of a flat border.
std::vector<double> flat_turning(const Region& region) {
    std::vector<double> turning;
    const std::size_t n = region.border.size();
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3 a =
            region.position(region.border[i]) - region.position(region.border[(i + n - 1) % n]);
        const Vec3 b =
            region.position(region.border[(i + 1) % n]) - region.position(region.border[i]);
        turning.push_back(std::atan2(a.x() * b.y() - a.y() * b.x(), a.x() * b.x() + a.y() * b.y()));
    }
    return turning;
}

}  // namespace

TEST_SUITE("core/border/border_angles") {
    TEST_CASE("both rules add up to a full turn on a curved region") {
        for (const AngleRule rule : {AngleRule::curvature, AngleRule::averaged_conformal}) {
            const Region region = test::dome(10, 0.9);
            const auto angles = angles_of(region, rule);
            CHECK(sum(angles.turning) == doctest::Approx(2 * pi).epsilon(1e-12));
            for (std::size_t i = 0; i < angles.turning.size(); ++i) {
                CHECK(sum(angles.corners[i]) ==
                      doctest::Approx(pi - angles.turning[i]).epsilon(1e-12));
            }
        }
    }

    TEST_CASE("both rules leave a flat border as it is") {
        for (const AngleRule rule : {AngleRule::curvature, AngleRule::averaged_conformal}) {
            const Region region = test::plane(7);
            const auto expected = flat_turning(region);
            const auto angles = angles_of(region, rule);
            for (std::size_t i = 0; i < expected.size(); ++i) {
                CHECK(angles.turning[i] == doctest::Approx(expected[i]).epsilon(1e-10));
            }
        }
    }

    TEST_CASE("curvature angles add up before anything is spread over the border") {
        // Gauss-Bonnet: on a curved disk the 3D turning lacks the inner curvature, and A u gives it
        // back. On a symmetric dome all four corners must therefore turn alike.
        const Region region = test::dome(8, 0.8);
        const auto angles = angles_of(region, AngleRule::curvature);
        std::vector<double> corners;
        for (std::size_t i = 0; i < region.border.size(); ++i) {
            const Index v = region.border[i];
            if (v == 0 || v == 8 || v == 72 || v == 80) corners.push_back(angles.turning[i]);
        }
        REQUIRE(corners.size() == 4);
        CHECK(corners[0] == doctest::Approx(corners[2]).epsilon(1e-9));
        CHECK(corners[0] > 1.0);
    }

    TEST_CASE("averaged conformal angles on a regular fan are the angles of the regular polygon") {
        // Six equilateral triangles around a raised centre: flattened, its ring is a hexagon.
        Region region;
        region.positions.emplace_back(0, 0, 0.7);
        for (int i = 0; i < 6; ++i) {
            region.positions.emplace_back(std::cos(i * pi / 3), std::sin(i * pi / 3), 0.0);
            region.triangles.push_back(
                {0, static_cast<Index>(1 + i), static_cast<Index>(1 + (i + 1) % 6)});
        }
        find_border(region);
        const auto angles = angles_of(region, AngleRule::averaged_conformal);
        for (const auto& corners : angles.corners) {
            REQUIRE(corners.size() == 2);
            CHECK(corners[0] == doctest::Approx(pi / 3).epsilon(1e-12));
        }
    }
}

}  // namespace lastflat
