#include "core/measure/report.h"

#include <doctest/doctest.h>

#include "core/error.h"
#include "core/measure/check_result.h"
#include "tests/helpers/constraints.h"
#include "tests/helpers/shapes.h"

namespace lastflat {
namespace {

Region flat_square() {
    return test::grid(4, 4, [](double s, double t) { return Vec3(20 * s, 20 * t, 0); });
}

Points2 stretched(const Region& region, double x, double y) {
    Points2 uv;
    for (const Vec3& p : region.positions) uv.emplace_back(x * p.x(), y * p.y());
    return uv;
}

}  // namespace

TEST_SUITE("core/measure/report") {
    TEST_CASE("an isometry measures one and zero") {
        const Region region = flat_square();
        const Metrics m = measure_distortion(region, stretched(region, 1, 1));
        CHECK(m.stretch_l2 == doctest::Approx(1.0));
        CHECK(m.stretch_linf == doctest::Approx(1.0));
        CHECK(m.symmetric_dirichlet == doctest::Approx(1.0));
        CHECK(m.angle_distortion == doctest::Approx(1.0));
        CHECK(m.area_error < 1e-12);
        CHECK(m.flipped_triangles == 0);
        CHECK(m.border_crossings == 0);
    }

    TEST_CASE("a stretch by 2 and 1/2 measures what the formulas give by hand") {
        const Region region = flat_square();
        const Metrics m = measure_distortion(region, stretched(region, 2, 0.5));
        // Plane to surface: G = 2, g = 1/2.
        CHECK(m.stretch_l2 == doctest::Approx(std::sqrt((4 + 0.25) / 2)));
        CHECK(m.stretch_linf == doctest::Approx(2.0));
        CHECK(m.symmetric_dirichlet == doctest::Approx((4 + 0.25 + 0.25 + 4) / 4));
        CHECK(m.angle_distortion == doctest::Approx((4 + 0.25) / 2));
        CHECK(m.area_error < 1e-12);
        CHECK(m.area_3d_mm2 == doctest::Approx(400.0));
    }

    TEST_CASE("a uniform scale shows in raw stretch and area, not in the normalised ones") {
        const Region region = flat_square();
        const Metrics m = measure_distortion(region, stretched(region, 1.1, 1.1));
        CHECK(m.stretch_l2 == doctest::Approx(1 / 1.1));
        CHECK(m.stretch_l2_normalised == doctest::Approx(1.0));
        CHECK(m.area_error == doctest::Approx(0.21));
        CHECK(m.area_error_p95 == doctest::Approx(0.21));
    }

    TEST_CASE("an area is judged where it was asked for, by how far it lies beyond") {
        Region region = flat_square();
        region.name = "vamp";
        const Metrics m = measure_distortion(region, stretched(region, 1.01, 1));
        CHECK_FALSE(m.area_verdict.has_value());
        CHECK_FALSE(area_verdict(region, m, {lock("bottom"), {TotalArea{0, 0, "quarter"}}}));
        CHECK(area_verdict(region, m, {{TotalArea{0, 1, "vamp"}}}) == Verdict::pass);
        CHECK(area_verdict(region, m, {{TotalArea{0, 0.6}}}) == Verdict::pass);
        CHECK(area_verdict(region, m, {{TotalArea{0, 0}}}) == Verdict::warn);
        CHECK(area_verdict(region, m, {{TotalArea{2.6, 5}}}) == Verdict::fail);
        CHECK(area_verdict(region, m, {{TotalArea{0, 1}}, {TotalArea{-3, -1}}}) == Verdict::fail);
    }

    TEST_CASE("a fold is counted and refused") {
        const Region region = flat_square();
        Points2 uv = stretched(region, 1, 1);
        uv[12] += Vec2(9, 0);  // the centre leaves its ring
        const Metrics m = measure_distortion(region, uv);
        CHECK(m.flipped_triangles > 0);
        std::vector<Warning> warnings;
        CHECK_THROWS_AS(check_result(region, uv, MethodName::mean_value, m, warnings), Error);
    }

    TEST_CASE("a border that crosses itself fails isometric and warns others") {
        // A strip bent once around: its ends overlap, but no triangle flips.
        const Region region =
            test::grid(40, 1, [](double s, double t) { return Vec3(200 * s, 10 * t, 0); });
        Points2 uv;
        for (const Vec3& p : region.positions) {
            const double angle = p.x() / 200 * 2 * M_PI * 1.1, r = 40 - p.y();
            uv.emplace_back(r * std::sin(angle), -r * std::cos(angle));
        }
        const Metrics m = measure_distortion(region, uv);
        CHECK(m.flipped_triangles == 0);
        CHECK(m.border_crossings > 0);
        std::vector<Warning> warnings;
        check_result(region, uv, MethodName::geodesic_fan, m, warnings);
        REQUIRE(warnings.size() == 1);
        CHECK(warnings[0].code == "border_crosses");
        CHECK_THROWS_AS(check_result(region, uv, MethodName::isometric, m, warnings), Error);
    }

    TEST_CASE("curves are measured edge by edge; only those that are locked are judged") {
        const Region region = flat_square();
        const Points2 uv = stretched(region, 1.015, 1);
        const auto free = measure_curves(region, uv, {});
        CHECK(free[0].name == "bottom");
        CHECK(free[0].length_3d_mm == doctest::Approx(20.0));
        CHECK(free[0].error_mm == doctest::Approx(0.3));
        CHECK(free[0].worst_edge_error_mm == doctest::Approx(0.075));
        CHECK(ease_percent(free[0].length_3d_mm, free[0].length_2d_mm) == doctest::Approx(1.5));
        for (const CurveReport& curve : free) CHECK_FALSE(curve.verdict.has_value());
        const auto ranged = measure_curves(region, uv, {{Range{"bottom", -1, 1}}});
        CHECK_FALSE(ranged[0].verdict.has_value());
        const auto locked = measure_curves(region, uv, {lock("bottom"), lock("left")});
        CHECK(locked[0].verdict == Verdict::fail);
        CHECK(locked[3].verdict == Verdict::pass);
    }

    TEST_CASE("edges that differ while their sum agrees pass a total lock only") {
        const Region region = flat_square();
        Points2 uv = stretched(region, 1, 1);
        uv[1].x() += 1;
        CHECK(measure_curves(region, uv, {lock("bottom", Keep::total)})[0].verdict ==
              Verdict::pass);
        CHECK(measure_curves(region, uv, {lock("bottom")})[0].verdict == Verdict::fail);
    }

    TEST_CASE("the two sides of one curve are compared") {
        Region a = flat_square(), b = flat_square();
        a.name = "a";
        b.name = "b";
        a.runs.resize(1);
        b.runs.resize(1);
        const auto pairs = measure_pairs({a, b}, {{stretched(a, 1, 1)}, {stretched(b, 1.01, 1)}});
        REQUIRE(pairs.size() == 1);
        CHECK(pairs[0].a == "a");
        CHECK(pairs[0].b == "b");
        CHECK(pairs[0].length_mm == doctest::Approx(20.0));
        CHECK(pairs[0].difference_mm == doctest::Approx(-0.2));
        CHECK(pairs[0].verdict == Verdict::fail);
    }
}

}  // namespace lastflat
