#include "core/optimize/wire_stiffness.h"

#include <doctest/doctest.h>

#include "tests/helpers/derivatives.h"
#include "tests/helpers/minimum.h"
#include "tests/helpers/shapes.h"

namespace lastflat {
namespace {

Eigen::VectorXd bent_chart(const Region& region) {
    Eigen::VectorXd x(2 * static_cast<Eigen::Index>(region.positions.size()));
    for (std::size_t i = 0; i < region.positions.size(); ++i) {
        const Vec3& p = region.positions[i];
        x.segment<2>(2 * static_cast<Eigen::Index>(i)) =
            Vec2(1.1 * p.x() + std::sin(0.2 * p.y()), 0.9 * p.y() + 0.004 * p.x() * p.x());
    }
    return x;
}

/// By how much the flat curve's turn changes from one vertex to the next, at most.
double roughness(const CurveRun& run, const Points2& uv) {
    double worst = 0.0, before = 0.0;
    for (std::size_t i = 1; i + 1 < run.vertices.size(); ++i) {
        const auto at = [&](std::size_t k) {
            return uv[static_cast<std::size_t>(run.vertices[k])];
        };
        const Vec2 e = at(i) - at(i - 1), f = at(i + 1) - at(i);
        const double turn = std::atan2(e.x() * f.y() - e.y() * f.x(), e.dot(f));
        if (i > 1) worst = std::max(worst, std::abs(turn - before));
        before = turn;
    }
    return worst;
}

}  // namespace

TEST_SUITE("core/optimize/wire_stiffness") {
    TEST_CASE("only curves locked by edges are stiff, and an unrolled one costs nothing") {
        const Region region = test::cylinder();
        const Domain domain({&region});
        CHECK(locked_wires(domain, {lock("bottom", Keep::total)}).empty());
        const WireStiffness wires(domain, locked_wires(domain, {lock("bottom"), lock("left")}));
        CHECK(wires.elements().size() == 22);
        const Minimum flat = test::minimised(
            region, flatten_fixed_border(region, mean_value_weights, circle_border(region)));
        CHECK(wires.value(domain.coordinates(flat.charts)) < 1e-12);
        CHECK(wires.value(bent_chart(region)) > 1e-6);
    }

    TEST_CASE("gradient and exact Hessian are the derivatives of the value") {
        const Region region = test::saddle(4);
        const Domain domain({&region});
        const WireStiffness wires(domain, locked_wires(domain, {lock("bottom"), lock("right")}));
        test::check_derivatives(wires, bent_chart(region), 1e-5, 1e-5);
        test::check_elements(wires, bent_chart(region));
    }

    TEST_CASE("a compressed locked curve of short edges stays smooth, and converges at once") {
        // The bottom is too long for its surroundings: a dome whose rim is locked.
        const Region region = test::dome(64, 0.7);
        const std::vector<Constraint> constraints{lock("bottom"), lock("right"), lock("top"),
                                                  lock("left")};
        const auto stiff = test::flattened({&region}, constraints);
        CHECK(stiff.minimum.converged);
        CHECK(stiff.minimum.iterations < 40);
        for (const CurveRun& run : region.runs)
            CHECK(roughness(run, stiff.minimum.charts[0].uv) < 0.02);
    }
}

}  // namespace lastflat
