#include <doctest/doctest.h>

#include "core/constrain/distortion_weights.h"
#include "core/measure/report.h"
#include "tests/helpers/minimum.h"
#include "tests/helpers/shapes.h"

namespace lastflat {
namespace {

Points2 scaled(const Region& region, double x, double y) {
    Points2 uv;
    for (const Vec3& p : region.positions) uv.emplace_back(x * p.x(), y * p.y());
    return uv;
}

}  // namespace

TEST_SUITE("core/measure/measure_stretch") {
    TEST_CASE("the leather is stretched where the pattern is smaller than the last") {
        const Region region = test::plane();
        const StretchReport report = measure_stretch(region, scaled(region, 0.8, 1.25), {});
        CHECK(report.most_stretched_percent == doctest::Approx(25.0));
        CHECK(report.most_gathered_percent == doctest::Approx(-20.0));
        CHECK(report.area.p01 == doctest::Approx(0.0));
        CHECK(measure_stretch(region, scaled(region, 0.8, 1), {}).area.p50 ==
              doctest::Approx(25.0));
        CHECK(report.larger.p50 == doctest::Approx(25.0));
        CHECK(report.smaller.p01 == doctest::Approx(-20.0));
        CHECK_FALSE(report.material_verdict.has_value());
    }

    TEST_CASE("the material's limits are judged on each sign") {
        const Region region = test::plane();
        const auto verdict = [&](double x, const MaterialLimits& limits) {
            return *measure_stretch(region, scaled(region, x, 1.0), limits).material_verdict;
        };
        CHECK(verdict(0.96, {5.0, 1.0}) == Verdict::pass);
        CHECK(verdict(0.96, {4.0, 1.0}) == Verdict::fail);
        CHECK(verdict(1.02, {5.0, 1.0}) == Verdict::fail);
        CHECK(verdict(1.02, {5.0, 2.0}) == Verdict::pass);
    }

    TEST_CASE("the worst places lie apart and the worst comes first") {
        const Region region = test::dome(12, 0.9);
        const Points2 uv = test::flattened({&region}, {}).minimum.charts[0].uv;
        const StretchReport report = measure_stretch(region, uv, {});
        REQUIRE(report.worst.size() == 10);
        const auto worst = [](const WorstStrain& p) {
            return std::max(std::abs(p.larger_percent), std::abs(p.smaller_percent));
        };
        CHECK(worst(report.worst[0]) == doctest::Approx(std::max(report.most_stretched_percent,
                                                                 -report.most_gathered_percent)));
        for (std::size_t i = 1; i < report.worst.size(); ++i) {
            CHECK(worst(report.worst[i]) <= worst(report.worst[i - 1]));
            for (std::size_t j = 0; j < i; ++j)
                CHECK((report.worst[i].position - report.worst[j].position).norm() > 1.0);
        }
    }
}

TEST_SUITE("core/constrain/distortion_weights") {
    TEST_CASE("a heavy zone is spared, a light one takes the distortion") {
        const Region region = test::dome(12, 0.9);
        const Domain domain({&region});
        const Chart start = flatten_fixed_border(region, mean_value_weights, circle_border(region));
        const SymmetricDirichlet energy;
        const auto in_zone = [&](double weight) {
            const std::vector<Zone> zones{{"left", -1, {}, 15.0, weight}};
            const auto weights = triangle_weights(region, zones);
            CHECK(std::count(weights.begin(), weights.end(), weight) > 20);
            const auto result = least_distortion(
                domain, {start}, {{}, energy, {weights}, OnConflict::fail, true}, 1, Progress());
            CHECK(result.minimum.converged);
            double worst = 0.0;
            for (const auto& place :
                 measure_stretch(region, result.minimum.charts[0].uv, {}).worst) {
                if (place.position.x() < -30) worst = std::max(worst, place.larger_percent);
            }
            return worst;
        };
        CHECK(in_zone(10.0) < 0.7 * in_zone(0.99));
        CHECK(in_zone(0.1) > 1.2 * in_zone(0.99));
    }

    TEST_CASE("a zone may be told by a point or by its vertices") {
        const Region region = test::plane();
        const auto near = triangle_weights(region, {{"", 40, {}, 12.0, 3.0}});
        CHECK(std::count(near.begin(), near.end(), 3.0) > 2);
        CHECK(std::count(near.begin(), near.end(), 1.0) > 50);
        const auto listed = triangle_weights(region, {{"", -1, {0, 1, 9, 10}, 0.0, 2.0}});
        CHECK(std::count(listed.begin(), listed.end(), 2.0) == 2);
    }

    TEST_CASE("dear compression is traded for stretch") {
        const Region region = test::dome(12, 0.9);
        const Domain domain({&region});
        const Chart start = flatten_fixed_border(region, mean_value_weights, circle_border(region));
        const auto measured = [&](const IsotropicEnergy& energy) {
            const auto result = least_distortion(
                domain, {start}, {{}, energy, {}, OnConflict::fail, true}, 1, Progress());
            CHECK(result.minimum.converged);
            return measure_stretch(region, result.minimum.charts[0].uv, {});
        };
        const auto even = measured(SymmetricDirichlet()), dear = measured(WeightedDirichlet(1, 10));
        CHECK(dear.most_gathered_percent > 0.8 * even.most_gathered_percent);
        CHECK(dear.most_stretched_percent > even.most_stretched_percent);
        CHECK(measured(WeightedDirichlet(1, 1)).most_stretched_percent ==
              doctest::Approx(even.most_stretched_percent).epsilon(1e-6));
    }
}

}  // namespace lastflat
