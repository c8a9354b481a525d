#include "core/constrain/constraint_rows.h"

#include <doctest/doctest.h>

#include "core/measure/report.h"
#include "tests/helpers/minimum.h"
#include "tests/helpers/shapes.h"

namespace lastflat {
namespace {

struct Solved {
    ConstrainedChart chart;
    std::vector<ConstraintReport> reports;
};

Solved solve(const std::vector<Region>& regions, const std::vector<Constraint>& constraints) {
    std::vector<const Region*> pointers;
    for (const Region& region : regions) pointers.push_back(&region);
    Solved solved{test::flattened(pointers, constraints), {}};
    solved.reports = measure_constraints(regions, solved.chart.minimum.charts, constraints);
    CHECK(solved.chart.minimum.converged);
    for (const auto& report : solved.reports) CHECK(report.kept);
    return solved;
}

}  // namespace

TEST_SUITE("core/constrain/constraint_rows") {
    TEST_CASE("a range binds only where the free curve would leave it") {
        const Region region = test::saddle();
        const Solved free = solve({region}, {});
        const auto curves = measure_curves(region, free.chart.minimum.charts[0].uv, {});
        const double percent = 100.0 * (curves[0].length_2d_mm / curves[0].length_3d_mm - 1.0);
        REQUIRE(std::abs(percent) > 0.01);
        const Range wide{"bottom", -std::abs(percent) - 1.0, std::abs(percent) + 1.0};
        const Range tight{"bottom", percent > 0 ? -1.0 : 0.4 * percent,
                          percent > 0 ? 0.4 * percent : 1.0};
        const Solved inside = solve({region}, {{wide}}), held = solve({region}, {{tight}});
        CHECK(inside.chart.minimum.energy ==
              doctest::Approx(free.chart.minimum.energy).epsilon(1e-12));
        CHECK(held.chart.minimum.energy > free.chart.minimum.energy * (1.0 + 1e-9));
        const double reached = held.reports[0].reached / curves[0].length_3d_mm - 1.0;
        CHECK(reached == doctest::Approx(0.004 * percent).epsilon(1e-6));
    }

    TEST_CASE("a range that pulls from one side is let go when it need not be held") {
        // The start, a circle, is far outside; the minimum is inside.
        const Region region = test::plane();
        const Range range{"bottom", -0.5, 0.5};
        CHECK(solve({region}, {{range}}).chart.minimum.energy ==
              doctest::Approx(1.0).epsilon(1e-10));
    }

    TEST_CASE("matched curves of two regions come out equally long, at the least cost") {
        Region a = test::saddle(), b = test::dome();
        a.name = "a";
        b.name = "b";
        Match match{"left", "a", "right", "b"};
        const auto groups = coupled_regions({a, b}, {{match}});
        REQUIRE(groups.size() == 1);
        const Solved solved = solve({a, b}, {{match}});
        CHECK(solved.reports[0].residual_mm == doctest::Approx(0.0).epsilon(1e-9));
        CHECK(coupled_regions({a, b}, {}).size() == 2);
        match.region.clear();
        CHECK_THROWS_AS((void)coupled_regions({a, a}, {{match}}), Error);
    }

    TEST_CASE("a straight curve lies on a line, and locked as well keeps its edges") {
        const Region region = test::dome(10, 0.8);
        const Solved solved = solve({region}, {{Straight{"bottom"}}, lock("bottom")});
        CHECK(solved.reports[0].reached < 1e-8);
        const auto& uv = solved.chart.minimum.charts[0].uv;
        CHECK((uv[0] - uv[10]).norm() ==
              doctest::Approx(solved.reports[1].asked_max).epsilon(1e-9));
    }

    TEST_CASE("the total area is the surface's, or inside its range") {
        const Region region = test::dome(10, 0.9);
        CHECK(solve({region}, {{TotalArea{}}}).reports[0].reached ==
              doctest::Approx(surface_area(region)).epsilon(1e-9));
        CHECK(solve({region}, {{TotalArea{3.0, 4.0}}}).reports[0].reached ==
              doctest::Approx(1.03 * surface_area(region)).epsilon(1e-9));
    }

    TEST_CASE("pins put points in their places; one costs nothing") {
        const Region region = test::saddle();
        const Minimum unpinned = solve({region}, {}).chart.minimum;
        const double free = unpinned.energy;
        const Pin a{0, {12, -7}}, b{168, {-30, 60}}, far{0, {9e4, -9e4}};
        const Solved one = solve({region}, {{a}});
        CHECK(one.chart.minimum.energy == doctest::Approx(free).epsilon(1e-10));
        CHECK(one.chart.minimum.iterations <= unpinned.iterations + 2);
        CHECK(solve({region}, {{far}, {Straight{"left"}}}).reports[1].kept);
        const Solved two = solve({region}, {{a}, {b}});
        CHECK((two.chart.minimum.charts[0].uv[168] - b.at).norm() < 1e-9);
        CHECK(two.chart.minimum.energy > free);
    }

    TEST_CASE("rows that follow from others go, rows that contradict them stay") {
        const auto row = [](std::vector<RowTerm> terms, double sum) {
            return ConstraintRow{{std::move(terms), sum, sum, 1.0, 0}, 0};
        };
        const auto edge = [](double factor, Index a) { return RowTerm{factor, Length{a, a + 1}}; };
        const std::vector<ConstraintRow> rows{
            row({edge(1, 0), edge(1, 1)}, 3.0),                            // 0: a + b = 3
            row({edge(1, 0)}, 1.0),                                        // 1: a = 1
            row({edge(1, 2), edge(1, 3)}, 3.0),                            // 2: c + d = 3
            row({edge(1, 0), edge(1, 1), edge(-1, 2), edge(-1, 3)}, 0.0),  // 3: follows from 0, 2
            row({edge(1, 1)}, 2.0),               // 4: with 1 it makes 0 follow
            row({edge(1, 1)}, 2.5),               // 5: contradicts 4
            row({edge(1, 2), edge(1, 3)}, 4.0)};  // 6: contradicts 2
        const auto of = [&](const std::vector<std::size_t>& chosen) {
            return distinct_rows(rows, chosen);
        };
        using Rows = std::vector<std::size_t>;
        CHECK(of({0, 2, 3}) == Rows{0, 2});
        CHECK(of({0, 1, 4}) == Rows{1, 4});
        CHECK(of({0, 1}) == Rows{0, 1});
        CHECK(of({3, 0, 1, 2, 4}) == Rows{1, 3, 4});  // 2 then follows from 3
        CHECK(of({4, 5}) == Rows{4, 5});
        CHECK(of({2, 6}) == Rows{2, 6});
    }

    TEST_CASE("two threads give the same bits as one") {
        const Region region = test::dome(40, 0.8);
        const std::vector<Constraint> constraints{lock("left"), lock("bottom")};
        const auto one = test::flattened({&region}, constraints, OnConflict::fail, 1);
        const auto two = test::flattened({&region}, constraints, OnConflict::fail, 2);
        CHECK(one.minimum.charts[0].uv == two.minimum.charts[0].uv);
    }
}

}  // namespace lastflat
