#include "core/optimize/border_contact.h"

#include <doctest/doctest.h>

#include "core/measure/report.h"
#include "tests/helpers/derivatives.h"
#include "tests/helpers/minimum.h"
#include "tests/helpers/shapes.h"

namespace lastflat {
namespace {

/// A strip bent almost into a ring, the gap between its ends `gap` mm wide in the middle.
Eigen::VectorXd bent_strip(const Region& region, double gap) {
    Eigen::VectorXd x(2 * static_cast<Eigen::Index>(region.positions.size()));
    const double turn = (2.0 * M_PI - gap / 40.0) / 200.0;
    for (std::size_t i = 0; i < region.positions.size(); ++i) {
        const Vec3& p = region.positions[i];
        const double angle = p.x() * turn, r = 45 - p.y();
        x.segment<2>(2 * static_cast<Eigen::Index>(i)) =
            Vec2(r * std::sin(angle) + 0.01 * p.y(), -r * std::cos(angle));
    }
    return x;
}

Region strip() {
    return test::grid(40, 2, [](double s, double t) { return Vec3(200 * s, 10 * t, 0); });
}

}  // namespace

TEST_SUITE("core/optimize/border_contact") {
    TEST_CASE("what stays apart feels nothing") {
        const Region region = strip();
        const Domain domain({&region});
        const BorderContact contact(domain);
        const Eigen::VectorXd x = bent_strip(region, 2.0);
        CHECK(contact.near_pairs(x).empty());
        CHECK(contact.value(x) == 0.0);
        CHECK(contact.largest_step(x, Eigen::VectorXd::Zero(x.size())) == 1.0);
    }

    TEST_CASE("gradient and exact Hessian are the derivatives of the barrier") {
        const Region region = strip();
        const Domain domain({&region});
        const BorderContact contact(domain);
        const Eigen::VectorXd x = bent_strip(region, 0.6 * contact.clearance());
        REQUIRE_FALSE(contact.near_pairs(x).empty());
        test::check_derivatives(contact, x, 1e-7, 1e-4);
        test::check_elements(contact, x);
        CHECK(contact.passing_pairs(x, 3.0).size() >= 2 * contact.near_pairs(x).size());
    }

    TEST_CASE("a border edge much shorter than the others is left as it is") {
        Region region = test::plane(6);
        region.positions[1] = region.positions[0] + Vec3(0.02, 0, 0);
        const auto result = test::flattened({&region}, {});
        CHECK(result.minimum.energy == doctest::Approx(1.0).epsilon(1e-10));
        const auto& uv = result.minimum.charts[0].uv;
        CHECK((uv[0] - uv[1]).norm() == doctest::Approx(0.02).epsilon(1e-5));
    }

    TEST_CASE("no step goes through an edge") {
        const Region region = strip();
        const Domain domain({&region});
        const BorderContact contact(domain);
        const Eigen::VectorXd apart = bent_strip(region, 3.0), across = bent_strip(region, -9.0);
        const Eigen::VectorXd way = across - apart;
        const double t = contact.largest_step(apart, way);
        CHECK(t > 0.1);
        CHECK(t < 0.5);
        const auto crossings = [&](double s) {
            const Points2 uv = domain.charts(apart + s * way)[0].uv;
            return measure_distortion(region, uv).border_crossings;
        };
        CHECK(crossings(t) == 0);
        CHECK(crossings(1.2 * t) > 0);
        for (const double share : {1.0 / 3.0, 40.0, 3000.0}) {  // however long the way is
            CAPTURE(share);
            CHECK(contact.largest_step(apart, share * way) == doctest::Approx(t / share));
        }
    }

    TEST_CASE("a ramp that turns more than once ends at its optimum without crossing") {
        const Region region = test::spiral();
        const auto result = test::flattened({&region}, {});
        const Metrics metrics = measure_distortion(region, result.minimum.charts[0].uv);
        CHECK(result.minimum.converged);
        CHECK(metrics.flipped_triangles == 0);
        CHECK(metrics.border_crossings == 0);
        // Free of contact it would lie on itself.
        const Minimum crossing = test::minimised(
            region, flatten_fixed_border(region, mean_value_weights, circle_border(region)));
        CHECK(measure_distortion(region, crossing.charts[0].uv).border_crossings > 0);
        CHECK(result.minimum.energy > crossing.energy);
    }

    TEST_CASE("a narrow ramp that winds up on itself is given up soon, and is sound") {
        const Region region = test::grid(700, 1, [](double s, double t) {
            const double angle = 6.0 * M_PI * s, r = 10.0 + 40.0 * t;
            return Vec3(r * std::cos(angle), r * std::sin(angle), 15.0 * s);
        });
        const auto result = test::flattened({&region}, {});
        const Metrics metrics = measure_distortion(region, result.minimum.charts[0].uv);
        CHECK(metrics.flipped_triangles == 0);
        CHECK(metrics.border_crossings == 0);
        CHECK_FALSE(result.minimum.converged);
        CHECK(result.minimum.iterations < 300);
    }

    TEST_CASE("locks hold in contact as well") {
        const Region region = test::spiral(1.2);
        const std::vector<Constraint> constraints{lock("bottom")};
        const auto result = test::flattened({&region}, constraints);
        CHECK(result.minimum.converged);
        CHECK(measure_constraints({region}, result.minimum.charts, constraints)[0].kept);
        CHECK(measure_distortion(region, result.minimum.charts[0].uv).border_crossings == 0);
    }
}

}  // namespace lastflat
