#include "core/constrain/constrained_newton.h"

#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include "core/border/convex_border.h"
#include "core/constrain/scale_to_locks.h"
#include "core/measure/report.h"
#include "core/parameterize/distortion.h"
#include "core/parameterize/fixed_border.h"
#include "core/parameterize/start.h"
#include "tests/helpers/shapes.h"

namespace lastflat {
namespace {

Minimum flattened(const Region& region, const std::vector<Lock>& locks = {}) {
    const Start start = start_chart(region, locked_border_edges(region, locks), {});
    return minimise_distortion(region, start.chart, length_constraints(region, locks),
                               SymmetricDirichlet(), Progress());
}

Minimum flattened_from_circle(const Region& region, const std::vector<Lock>& locks = {}) {
    return minimise_distortion(
        region, flatten_fixed_border(region, mean_value_weights, circle_border(region)),
        length_constraints(region, locks), SymmetricDirichlet(), Progress());
}

Points2 shadow(const Region& region) {
    Points2 points;
    for (const Vec3& p : region.positions) points.push_back(p.head<2>());
    return points;
}

}  // namespace

TEST_SUITE("core/constrain/constrained_newton") {
    TEST_CASE("a flat region keeps its shape") {
        const Region region = test::plane(10);
        CHECK(test::rigid_difference(flattened(region).chart.uv, shadow(region)) < 1e-8);
        CHECK(test::rigid_difference(flattened_from_circle(region).chart.uv, shadow(region)) <
              1e-8);
    }

    TEST_CASE("developable patches come out without distortion") {
        for (const Region& region : {test::cylinder(), test::cone()}) {
            // The triangles of a cylinder unroll exactly; those of a cone do as well.
            CHECK(flattened(region).energy == doctest::Approx(1.0).epsilon(1e-12));
            CHECK(test::worst_edge_change(region, flattened(region).chart.uv) < 1e-7);
        }
    }

    TEST_CASE("locks on a plane change nothing") {
        const Region region = test::plane(10);
        const Minimum locked = flattened(region, {{"bottom"}, {"left"}, {"top", Keep::total}});
        CHECK(test::rigid_difference(locked.chart.uv, shadow(region)) < 1e-8);
    }

    TEST_CASE("every locked edge has its length on a curved region") {
        for (const Region& region : {test::dome(), test::saddle()}) {
            const Minimum minimum = flattened(region, {{"bottom"}, {"top"}});
            for (const auto& constraint : length_constraints(region, {{"bottom"}, {"top"}})) {
                const auto [a, b] = constraint.edges.front();
                const double flat = (minimum.chart.uv[static_cast<std::size_t>(a)] -
                                     minimum.chart.uv[static_cast<std::size_t>(b)])
                                        .norm();
                CHECK(std::abs(flat / region.distance(a, b) - 1) < 1e-10);
            }
            CHECK(flipped_triangles(region, minimum.chart.uv).empty());
        }
    }

    TEST_CASE("a total lock keeps the sum and costs less than locking every edge") {
        const Region region = test::saddle();
        const Minimum edges = flattened(region, {{"left"}}),
                      total = flattened(region, {{"left", Keep::total}}), free = flattened(region);
        const auto report = measure_curves(region, total.chart.uv, {{"left", Keep::total}});
        CHECK(std::abs(report[3].error_mm) < 1e-9);
        CHECK(free.energy < total.energy);
        CHECK(total.energy < edges.energy);
    }

    TEST_CASE("the same minimum is reached from a circle and from the fan") {
        for (const Region& region : {test::dome(), test::saddle()}) {
            for (const std::vector<Lock>& locks :
                 {std::vector<Lock>{}, std::vector<Lock>{{"left"}, {"top"}}}) {
                const Minimum a = flattened(region, locks),
                              b = flattened_from_circle(region, locks);
                CHECK(a.energy == doctest::Approx(b.energy).epsilon(1e-10));
                CHECK(test::rigid_difference(a.chart.uv, b.chart.uv) < 1e-5);
            }
        }
    }

    TEST_CASE("the minimum is one: small moves along the constraints cost energy") {
        const Region region = test::saddle(8);
        const Minimum minimum = flattened(region);
        const SymmetricDirichlet energy;
        const Distortion distortion(region, energy);
        Eigen::VectorXd x(2 * static_cast<Eigen::Index>(minimum.chart.uv.size()));
        for (std::size_t i = 0; i < minimum.chart.uv.size(); ++i) {
            x.segment<2>(2 * static_cast<Eigen::Index>(i)) = minimum.chart.uv[i];
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
        const std::vector<Lock> locks{{"bottom"}, {"right"}};
        const Points2 expected = flattened(region, locks).chart.uv;

        Region moved = region;
        const Eigen::Matrix3d turn =
            Eigen::AngleAxisd(2.0, Vec3(1, -1, 3).normalized()).toRotationMatrix();
        for (Vec3& p : moved.positions) p = turn * p + Vec3(-30, 400, 12);
        CHECK(test::rigid_difference(expected, flattened(moved, locks).chart.uv) < 1e-7);

        Region reordered = region;  // other order of triangles, other first corner
        std::reverse(reordered.triangles.begin(), reordered.triangles.end());
        for (Triangle& t : reordered.triangles) std::rotate(t.begin(), t.begin() + 1, t.end());
        CHECK(test::rigid_difference(expected, flattened(reordered, locks).chart.uv) < 1e-7);

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
        renumbered.border = checked_border(renumbered);
        const Points2 found = flattened(renumbered, locks).chart.uv;
        Points2 back(found.size());
        for (Index v = 0; v < n; ++v)
            back[static_cast<std::size_t>(v)] = found[static_cast<std::size_t>(other(v))];
        CHECK(test::rigid_difference(expected, back) < 1e-7);
    }

    TEST_CASE("lengths that cannot be kept are an error that names a curve") {
        // On a dome the whole border and a ring inside it cannot all keep their edges.
        Region region = test::dome(6, 1.3);
        std::vector<Lock> locks{{"bottom"}, {"right"}, {"top"}, {"left"}};
        for (int j = 1; j < 6; ++j) {
            const std::string name = "row " + std::to_string(j);
            region.runs.push_back({name, {}});
            for (int i = 0; i <= 6; ++i) region.runs.back().vertices.push_back(j * 7 + i);
            locks.push_back({name});
            region.runs.push_back({"column " + std::to_string(j), {}});
            for (int i = 0; i <= 6; ++i) region.runs.back().vertices.push_back(i * 7 + j);
            locks.push_back({"column " + std::to_string(j)});
        }
        // All grid lines locked leaves the cells rhombs free to shear: still feasible or not, the
        // diagonals of one row make it rigid.
        region.runs.push_back({"diagonal", {}});
        for (int i = 0; i <= 6; ++i) region.runs.back().vertices.push_back(i * 8);
        locks.push_back({"diagonal"});
        try {
            (void)flattened_from_circle(region, locks);
            FAIL("no error");
        } catch (const Error& error) {
            CHECK(error.code() == ErrorCode::constraints_infeasible);
            CHECK(std::string(error.what()).find("curve '") != std::string::npos);
            CHECK(error.position().has_value());
        }
    }

    TEST_CASE("a cancelled job stops") {
        Progress progress;
        progress.cancel();
        const Region region = test::dome();
        const Chart start = flatten_fixed_border(region, mean_value_weights, circle_border(region));
        CHECK_THROWS_AS(
            (void)minimise_distortion(region, start, {}, SymmetricDirichlet(), progress), Error);
    }

    TEST_CASE("a folded start is refused") {
        const Region region = test::plane(4);
        Points2 folded = shadow(region);
        folded[12] += Vec2(200, 0);
        CHECK_THROWS_AS(
            (void)minimise_distortion(region, {folded}, {}, SymmetricDirichlet(), Progress()),
            Error);
    }
}

}  // namespace lastflat
