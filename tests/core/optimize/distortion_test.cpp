#include "core/optimize/distortion.h"

#include <doctest/doctest.h>

#include "core/measure/report.h"
#include "tests/helpers/derivatives.h"
#include "tests/helpers/shapes.h"

namespace lastflat {
namespace {

/// A chart away from any symmetry and minimum.
Eigen::VectorXd some_chart(const Region& region) {
    Eigen::VectorXd x(2 * static_cast<Eigen::Index>(region.positions.size()));
    for (std::size_t i = 0; i < region.positions.size(); ++i) {
        const Vec3& p = region.positions[i];
        x.segment<2>(2 * static_cast<Eigen::Index>(i)) =
            Vec2(1.2 * p.x() + 0.1 * p.y() + std::sin(0.05 * p.y()),
                 0.8 * p.y() + 0.002 * p.x() * p.x());
    }
    return x;
}

}  // namespace

TEST_SUITE("core/optimize/distortion") {
    TEST_CASE("gradient and exact Hessian are the derivatives of the value") {
        const Region region = test::saddle(3);
        const SymmetricDirichlet energy;
        const Distortion distortion(Domain({&region}), energy);
        test::check_derivatives(distortion, some_chart(region), 1e-5, 1e-6);
    }

    TEST_CASE("the projected Hessian has no negative eigenvalue") {
        const Region region = test::saddle(3);
        const SymmetricDirichlet energy;
        const Distortion distortion(Domain({&region}), energy);
        const Eigen::VectorXd x = 0.4 * some_chart(region);  // compressed: the exact one has
        const auto least = [&](HessianKind kind) {
            const Eigen::MatrixXd hessian = test::hessian_of(distortion, x, kind);
            return hessian.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff();
        };
        CHECK(least(HessianKind::exact) < -0.1);
        CHECK(least(HessianKind::projected) > -1e-9);
        test::check_elements(distortion, x);
    }

    TEST_CASE("the value agrees with the report, which is written from other formulas") {
        const Region region = test::saddle(6);
        const SymmetricDirichlet energy;
        const Domain domain({&region});
        const Distortion distortion(domain, energy);
        const Eigen::VectorXd x = some_chart(region);
        Points2 uv;
        for (Eigen::Index i = 0; i < x.size(); i += 2) uv.push_back(x.segment<2>(i));
        CHECK(distortion.value(x) / distortion.total_area() ==
              doctest::Approx(measure_distortion(region, uv).symmetric_dirichlet).epsilon(1e-12));
    }

    TEST_CASE("the largest step ends where the first triangle would lose its area") {
        const Region region = test::plane(3);
        const SymmetricDirichlet energy;
        const Domain domain({&region});
        const Distortion distortion(domain, energy);
        const Eigen::VectorXd x = some_chart(region);
        Eigen::VectorXd d = Eigen::VectorXd::Zero(x.size());
        d[2 * 5] = 100.0;  // one inner vertex runs through its ring
        const double t = distortion.largest_step(x, d);
        CHECK(t < 0.9);
        CHECK(std::isfinite(distortion.value(x + t * d)));
        CHECK(std::isinf(distortion.value(x + t / 0.949 * d)));
        CHECK(distortion.largest_step(x, Eigen::VectorXd::Ones(x.size())) == 1.0);
    }
}

}  // namespace lastflat
