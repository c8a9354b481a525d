#include "core/fan/geodesic_fan.h"

#include <doctest/doctest.h>

#include <numbers>

#include "core/fan/geodesic_centre.h"
#include "tests/helpers/shapes.h"

namespace lastflat {

TEST_SUITE("core/fan/geodesic_fan") {
    TEST_CASE("the centre is the one that trying every inner vertex finds, in few runs") {
        for (const Region& region : {test::dome(13, 1.2), test::saddle(14), test::plane(11)}) {
            const ExactGeodesics geodesics(region);
            const auto mask = border_mask(region);
            double best = 1e300;
            for (Index v = 0; v < static_cast<Index>(mask.size()); ++v) {
                if (mask[static_cast<std::size_t>(v)]) continue;
                const auto distances = geodesics.from_vertex(v, Progress());
                double radius = 0;
                for (const Index b : region.border)
                    radius = std::max(radius, distances.distance[static_cast<std::size_t>(b)]);
                best = std::min(best, radius);
            }
            const GeodesicCentre centre = geodesic_centre(region, geodesics, Progress());
            CHECK(centre.radius == doctest::Approx(best).epsilon(1e-11));
            CHECK(centre.runs <= 20);
        }
    }

    TEST_CASE("on a plane the fan is the border in polar coordinates") {
        const Region region =
            test::grid(12, 8, [](double s, double t) { return Vec3(90 * s, 60 * t, 0); });
        const GeodesicFan fan = geodesic_fan(region, false, Progress());
        const Vec3 centre = region.position(fan.centre);
        CHECK((centre - Vec3(45, 30, 0)).norm() < 1e-12);
        REQUIRE(fan.spokes.size() == region.border.size());
        const auto polar = [&](std::size_t i) {
            const Vec3 d = region.position(region.border[i]) - centre;
            return std::atan2(d.y(), d.x());
        };
        const double turn = fan.spokes[0].angle - polar(0);
        for (std::size_t i = 0; i < fan.spokes.size(); ++i) {
            CHECK(fan.spokes[i].distance ==
                  doctest::Approx((region.position(region.border[i]) - centre).norm())
                      .epsilon(1e-12));
            const double off =
                std::remainder(fan.spokes[i].angle - polar(i) - turn, 2 * std::numbers::pi);
            CHECK(std::abs(off) < 1e-9);
        }
        CHECK(fan.radius == doctest::Approx(std::hypot(45, 30)).epsilon(1e-12));
        CHECK(fan.greatest_distance == doctest::Approx(fan.radius));
        CHECK(fan.mean_distance < fan.radius);
    }

    TEST_CASE("spokes follow one another around the border once") {
        for (const Region& region : {test::dome(12, 1.2), test::saddle(13)}) {
            const GeodesicFan fan = geodesic_fan(region, false, Progress());
            double turned = 0;
            for (std::size_t i = 0; i < fan.spokes.size(); ++i) {
                const double step = std::remainder(
                    fan.spokes[(i + 1) % fan.spokes.size()].angle - fan.spokes[i].angle,
                    2 * std::numbers::pi);
                CHECK(step > -1e-9);
                turned += step;
            }
            CHECK(turned == doctest::Approx(2 * std::numbers::pi));
        }
    }

    TEST_CASE("a region without inner vertices has its centre on the border") {
        Region region;
        region.positions = {{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}};
        region.triangles = {{0, 1, 2}, {0, 2, 3}};
        find_border(region);
        const GeodesicFan fan = geodesic_fan(region, false, Progress());
        CHECK(fan.radius == doctest::Approx(5.0));
        CHECK(fan.spokes.size() == 4);
    }

    TEST_CASE("a tube of perfect symmetry, where a ring of vertices ties, is given up in time") {
        constexpr int around = 90;
        Region region;
        region.positions.emplace_back(0, 0, 60);
        for (int k = 0; k <= 2; ++k) {
            for (int i = 0; i < around; ++i) {
                const double a = 2 * std::numbers::pi * i / around;
                region.positions.emplace_back(20 * std::cos(a), 20 * std::sin(a), 60 - 30.0 * k);
            }
        }
        const auto id = [&](int k, int i) {
            return static_cast<Index>(1 + k * around + i % around);
        };
        for (int i = 0; i < around; ++i) {
            region.triangles.push_back({0, id(0, i), id(0, i + 1)});
            for (int k = 0; k < 2; ++k) {
                region.triangles.push_back({id(k, i), id(k + 1, i), id(k + 1, i + 1)});
                region.triangles.push_back({id(k, i), id(k + 1, i + 1), id(k, i + 1)});
            }
        }
        find_border(region);
        const ExactGeodesics geodesics(region);
        CHECK_THROWS_AS((void)geodesic_centre(region, geodesics, Progress()), Error);
    }
}

}  // namespace lastflat
