#include "core/constrain/minimise_distortion.h"

#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include "core/border/convex_border.h"
#include "core/constrain/scale_to_locks.h"
#include "core/measure/report.h"
#include "core/numerics/tolerances.h"
#include "core/optimize/distortion.h"
#include "core/parameterize/fixed_border.h"
#include "core/parameterize/start.h"
#include "tests/helpers/minimum.h"
#include "tests/helpers/shapes.h"

namespace lastflat {
namespace {

Minimum flattened(const Region& region, const std::vector<Constraint>& constraints = {}) {
    const Start start = start_chart(region, locked_border_edges(region, constraints), {});
    return test::minimised(region, start.chart, constraints);
}

Minimum flattened_from_circle(const Region& region,
                              const std::vector<Constraint>& constraints = {}) {
    return test::minimised(region,
                           flatten_fixed_border(region, mean_value_weights, circle_border(region)),
                           constraints);
}

Points2 shadow(const Region& region) {
    Points2 points;
    for (const Vec3& p : region.positions) points.push_back(p.head<2>());
    return points;
}

}  // namespace

TEST_SUITE("core/constrain/minimise_distortion") {
    TEST_CASE("a flat region keeps its shape") {
        const Region region = test::plane(10);
        CHECK(test::rigid_difference(flattened(region).charts[0].uv, shadow(region)) < 1e-8);
        CHECK(test::rigid_difference(flattened_from_circle(region).charts[0].uv, shadow(region)) <
              1e-8);
    }

    TEST_CASE("developable patches come out without distortion") {
        for (const Region& region : {test::cylinder(), test::cone()}) {
            // The triangles of a cylinder unroll exactly; those of a cone do as well.
            CHECK(flattened(region).energy == doctest::Approx(1.0).epsilon(1e-12));
            CHECK(test::worst_edge_change(region, flattened(region).charts[0].uv) < 1e-7);
        }
    }

    TEST_CASE("locks on a plane change nothing") {
        const Region region = test::plane(10);
        const Minimum locked =
            flattened(region, {lock("bottom"), lock("left"), lock("top", Keep::total)});
        CHECK(test::rigid_difference(locked.charts[0].uv, shadow(region)) < 1e-8);
    }

    TEST_CASE("every locked edge has its length on a curved region") {
        for (const Region& region : {test::dome(), test::saddle()}) {
            const Minimum minimum = flattened(region, {lock("bottom"), lock("top")});
            for (const CurveRun& run : region.runs) {
                if (run.curve != "bottom" && run.curve != "top") continue;
                for (std::size_t i = 1; i < run.vertices.size(); ++i) {
                    const Index a = run.vertices[i - 1], b = run.vertices[i];
                    const double flat = (minimum.charts[0].uv[static_cast<std::size_t>(a)] -
                                         minimum.charts[0].uv[static_cast<std::size_t>(b)])
                                            .norm();
                    CHECK(std::abs(flat / region.distance(a, b) - 1) < 1e-10);
                }
            }
            CHECK(flipped_triangles(region, minimum.charts[0].uv).empty());
        }
    }

    TEST_CASE("a total lock keeps the sum and costs less than locking every edge") {
        const Region region = test::saddle();
        const Minimum edges = flattened(region, {lock("left")}),
                      total = flattened(region, {lock("left", Keep::total)}),
                      free = flattened(region);
        const auto report = measure_curves(region, total.charts[0].uv, {lock("left", Keep::total)});
        CHECK(std::abs(report[3].error_mm) < tolerance::solver_length * report[3].length_3d_mm);
        CHECK(free.energy < total.energy);
        CHECK(total.energy < edges.energy);
    }

    TEST_CASE("the same minimum is reached from a fan that was shaken") {
        const Region region = test::saddle();
        const std::vector<Constraint> locks{lock("left"), lock("top")};
        Chart start = start_chart(region, locked_border_edges(region, locks), {}).chart;
        const Minimum calm = test::minimised(region, start, locks);
        for (std::size_t i = 0; i < start.uv.size(); ++i)
            start.uv[i] += 0.9 * Vec2(std::sin(7.0 * static_cast<double>(i)),
                                      std::cos(11.0 * static_cast<double>(i)));
        REQUIRE(flipped_triangles(region, start.uv).empty());
        const Minimum shaken = test::minimised(region, start, locks);
        CHECK(shaken.energy == doctest::Approx(calm.energy).epsilon(1e-12));
        CHECK(test::rigid_difference(calm.charts[0].uv, shaken.charts[0].uv) < 1e-6);
    }

    TEST_CASE("the same minimum is reached from a circle and from the fan") {
        for (const Region& region : {test::dome(), test::saddle()}) {
            for (const std::vector<Constraint>& locks :
                 {std::vector<Constraint>{}, std::vector<Constraint>{lock("left"), lock("top")}}) {
                const Minimum a = flattened(region, locks),
                              b = flattened_from_circle(region, locks);
                CHECK(a.energy == doctest::Approx(b.energy).epsilon(1e-10));
                CHECK(test::rigid_difference(a.charts[0].uv, b.charts[0].uv) < 1e-5);
            }
        }
    }

    TEST_CASE("far from isometry a bad start and a good one end at the same minimum") {
        const auto deep_cup = [](double s, double t) {
            const double x = 2.0 * s - 1.0, y = 2.0 * t - 1.0;
            const double r = std::max(std::abs(x), std::abs(y)), angle = std::atan2(y, x);
            const double radius = std::min(60.0 * r, 30.0), depth = std::max(0.0, 140.0 * r - 70.0);
            return Vec3(radius * std::cos(angle), radius * std::sin(angle), depth);
        };
        const Region region = test::grid(24, 24, deep_cup);
        const Minimum from_circle = flattened_from_circle(region);
        REQUIRE(from_circle.converged);
        CHECK(from_circle.energy > 1.2);
        CHECK(from_circle.iterations < 60);
        Chart near = from_circle.charts[0];
        for (std::size_t i = 0; i < near.uv.size(); ++i)
            near.uv[i] += 0.05 * Vec2(std::sin(7.0 * static_cast<double>(i)),
                                      std::cos(11.0 * static_cast<double>(i)));
        REQUIRE(flipped_triangles(region, near.uv).empty());
        const Minimum from_near = test::minimised(region, near);
        CHECK(from_near.energy == doctest::Approx(from_circle.energy).epsilon(1e-10));
    }

    TEST_CASE("the minimum is one: small moves along the constraints cost energy") {
        const Region region = test::saddle(8);
        const Minimum minimum = flattened(region);
        const SymmetricDirichlet energy;
        const Domain domain({&region});
        const Distortion distortion(domain, energy);
        Eigen::VectorXd x(2 * static_cast<Eigen::Index>(minimum.charts[0].uv.size()));
        for (std::size_t i = 0; i < minimum.charts[0].uv.size(); ++i) {
            x.segment<2>(2 * static_cast<Eigen::Index>(i)) = minimum.charts[0].uv[i];
        }
        const double at_rest = distortion.value(x);
        for (Eigen::Index i = 0; i < x.size(); i += 7) {
            for (const double h : {1e-3, -1e-3}) {
                Eigen::VectorXd moved = x;
                moved[i] += h;
                CHECK(distortion.value(moved) > at_rest);
            }
        }
    }

    TEST_CASE("turning, moving and renumbering the region changes nothing") {
        const Region region = test::saddle();
        const std::vector<Constraint> locks{lock("bottom"), lock("right")};
        const Points2 expected = flattened(region, locks).charts[0].uv;

        Region moved = region;
        const Eigen::Matrix3d turn =
            Eigen::AngleAxisd(2.0, Vec3(1, -1, 3).normalized()).toRotationMatrix();
        for (Vec3& p : moved.positions) p = turn * p + Vec3(-30, 400, 12);
        CHECK(test::rigid_difference(expected, flattened(moved, locks).charts[0].uv) < 1e-7);

        Region reordered = region;  // other order of triangles, other first corner
        std::reverse(reordered.triangles.begin(), reordered.triangles.end());
        for (Triangle& t : reordered.triangles) std::rotate(t.begin(), t.begin() + 1, t.end());
        CHECK(test::rigid_difference(expected, flattened(reordered, locks).charts[0].uv) < 1e-7);

        Region renumbered = region;
        const auto n = static_cast<Index>(region.positions.size());
        const auto other = [n](Index v) { return (v * 5 + 3) % n; };  // 5 has no factor of n = 169
        for (Index v = 0; v < n; ++v)
            renumbered.positions[static_cast<std::size_t>(other(v))] = region.position(v);
        for (Triangle& t : renumbered.triangles) {
            for (Index& v : t) v = other(v);
        }
        for (CurveRun& run : renumbered.runs) {
            for (Index& v : run.vertices) v = other(v);
        }
        find_border(renumbered);
        const Points2 found = flattened(renumbered, locks).charts[0].uv;
        Points2 back(found.size());
        for (Index v = 0; v < n; ++v)
            back[static_cast<std::size_t>(v)] = found[static_cast<std::size_t>(other(v))];
        CHECK(test::rigid_difference(expected, back) < 1e-7);
    }

    TEST_CASE("a canceled job stops") {
        Progress progress;
        progress.cancel();
        const Region region = test::dome();
        const Chart start = flatten_fixed_border(region, mean_value_weights, circle_border(region));
        CHECK_THROWS_AS((void)test::minimised(region, start, {}, SymmetricDirichlet(), progress),
                        Error);
    }

    TEST_CASE("a folded start is refused") {
        const Region region = test::plane(4);
        Points2 folded = shadow(region);
        folded[12] += Vec2(200, 0);
        CHECK_THROWS_AS((void)test::minimised(region, {folded}), Error);
    }
}

}  // namespace lastflat
