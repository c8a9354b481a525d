#include "core/optimize/isotropic_energy.h"

#include <doctest/doctest.h>

#include <cmath>

#include "core/constrain/minimise_distortion.h"
#include "core/measure/report.h"
#include "core/parameterize/start.h"
#include "tests/helpers/minimum.h"
#include "tests/helpers/shapes.h"

namespace lastflat {
namespace {

void check_derivatives(const IsotropicEnergy& energy) {
    for (const auto& [s1, s2] : {std::pair(1.3, 0.8), std::pair(0.7, 0.6), std::pair(2.0, 1.9)}) {
        const EnergyDerivatives e = energy.derivatives(s1, s2);
        const double h = 1e-5;
        const auto f = [&](double a, double b) { return energy.value(s1 + a * h, s2 + b * h); };
        CHECK(e.value == f(0, 0));
        CHECK(e.d1 == doctest::Approx((f(1, 0) - f(-1, 0)) / (2 * h)).epsilon(1e-7));
        CHECK(e.d2 == doctest::Approx((f(0, 1) - f(0, -1)) / (2 * h)).epsilon(1e-7));
        CHECK(e.d11 == doctest::Approx((f(1, 0) - 2 * f(0, 0) + f(-1, 0)) / (h * h)).epsilon(1e-4));
        CHECK(e.d22 == doctest::Approx((f(0, 1) - 2 * f(0, 0) + f(0, -1)) / (h * h)).epsilon(1e-4));
        const double mixed = (f(1, 1) - f(1, -1) - f(-1, 1) + f(-1, -1)) / (4 * h * h);
        CHECK(std::abs(e.d12 - mixed) < 1e-4);
        CHECK(e.twist == doctest::Approx((e.d1 + e.d2) / (s1 + s2)));
        CHECK(e.flip == doctest::Approx((e.d1 - e.d2) / (s1 - s2)));
    }
}

Minimum minimised(const Region& region, const IsotropicEnergy& energy, MethodName name) {
    const std::vector<bool> free(region.border.size(), false);
    return test::minimised(region, start_chart(region, free, {name}).chart, {}, energy);
}

}  // namespace

TEST_SUITE("core/optimize/isotropic_energy") {
    TEST_CASE("derivatives are those of the value") {
        check_derivatives(WeightedDirichlet(1.0, 4.0));
        check_derivatives(SymmetricDirichlet());
        check_derivatives(Mips());
        check_derivatives(GreenLagrange());
    }

    TEST_CASE("every energy is one at its ideal and more elsewhere") {
        CHECK(SymmetricDirichlet().value(1, 1) == 1);
        CHECK(GreenLagrange().value(1, 1) == 1);
        CHECK(Mips().value(3, 3) == 1);
        CHECK(SymmetricDirichlet().value(1.1, 1) > 1);
        CHECK(GreenLagrange().value(1.1, 1) > 1);
        CHECK(Mips().value(1.1, 1) > 1);
    }

    TEST_CASE("developable patches come out without distortion under each energy") {
        for (const Region& region : {test::cylinder(), test::cone()}) {
            CHECK(minimised(region, Mips(), MethodName::mips).energy ==
                  doctest::Approx(1.0).epsilon(1e-11));
            const Minimum strain = minimised(region, GreenLagrange(), MethodName::green_lagrange);
            CHECK(strain.energy == doctest::Approx(1.0).epsilon(1e-11));
            CHECK(test::worst_edge_change(region, strain.charts[0].uv) < 1e-5);
        }
    }

    TEST_CASE("each energy is best in its own measure") {
        const Region region = test::dome(12, 0.9);
        const auto measured = [&](const Minimum& minimum) {
            return measure_distortion(region, minimum.charts[0].uv);
        };
        const Minimum isometric = minimised(region, SymmetricDirichlet(), MethodName::isometric);
        const Minimum mips = minimised(region, Mips(), MethodName::mips);
        const Minimum strain = minimised(region, GreenLagrange(), MethodName::green_lagrange);
        for (const Minimum* minimum : {&isometric, &mips, &strain}) CHECK(minimum->converged);
        CHECK(mips.energy == doctest::Approx(measured(mips).angle_distortion).epsilon(1e-12));
        CHECK(measured(mips).angle_distortion < measured(isometric).angle_distortion);
        CHECK(measured(isometric).symmetric_dirichlet < measured(strain).symmetric_dirichlet);
        CHECK(measured(isometric).symmetric_dirichlet < measured(mips).symmetric_dirichlet);
    }
}

}  // namespace lastflat
