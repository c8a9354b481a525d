#include "core/measure/strain_field.h"

#include <doctest/doctest.h>

#include "core/measure/report.h"
#include "tests/helpers/shapes.h"

namespace lastflat {
namespace {

Points2 flat_with(const Region& region, double x, double y) {
    Points2 uv;
    for (const Vec3& p : region.positions) uv.emplace_back(x * p.x(), y * p.y());
    return uv;
}

double everywhere(const std::vector<double>& strains) {
    for (const double strain : strains) CHECK(strain == doctest::Approx(strains.front()));
    return strains.front();
}

}  // namespace

TEST_SUITE("core/measure/strain_field") {
    TEST_CASE("each shading is what the formulas give by hand, above 0 where leather stretches") {
        const Region region = test::plane();
        const Points2 uv = flat_with(region, 0.8, 1.25);
        CHECK(everywhere(triangle_strains(region, uv, Shading::stretch)) == doctest::Approx(25.0));
        CHECK(everywhere(triangle_strains(region, uv, Shading::gather)) == doctest::Approx(-20.0));
        CHECK(std::abs(everywhere(triangle_strains(region, uv, Shading::area))) < 1e-9);
        const double half = std::atan2(0.8, 1.25) * 180.0 / M_PI;
        CHECK(everywhere(triangle_strains(region, uv, Shading::shear)) ==
              doctest::Approx(90.0 - 2.0 * half));
        CHECK(triangle_strains(region, uv, Shading::plain).empty());
        CHECK(everywhere(triangle_strains(region, flat_with(region, 0.8, 1), Shading::area)) ==
              doctest::Approx(25.0));
    }

    TEST_CASE("a pure shear by an angle is that angle") {
        const Region region = test::plane();
        Points2 uv;
        for (const Vec3& p : region.positions)
            uv.emplace_back(p.x() + std::sin(0.1) * p.y(), std::cos(0.1) * p.y());
        CHECK(everywhere(triangle_strains(region, uv, Shading::shear)) ==
              doctest::Approx(0.1 * 180.0 / M_PI));
    }

    TEST_CASE("the drawing's strains are those of the report") {
        const Region region = test::dome(8, 0.9);
        const Points2 uv = flat_with(region, 1.0, 1.1);
        const StretchReport report = measure_stretch(region, uv, {});
        const auto stretch = triangle_strains(region, uv, Shading::stretch);
        const auto gather = triangle_strains(region, uv, Shading::gather);
        CHECK(stretch[worst_triangle(stretch, Shading::stretch)] == report.most_stretched_percent);
        CHECK(gather[worst_triangle(gather, Shading::gather)] == report.most_gathered_percent);
    }

    TEST_CASE("a vertex has the mean of its triangles by their area") {
        Region region;
        region.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-3, 0, 0}};
        region.triangles = {{0, 1, 2}, {0, 2, 3}};
        const auto means = vertex_means(region, {4.0, 8.0});
        CHECK(means[1] == doctest::Approx(4.0));
        CHECK(means[0] == doctest::Approx((4.0 + 3 * 8.0) / 4));
        CHECK(means[3] == doctest::Approx(8.0));
    }

    TEST_CASE("the worst is the one furthest to the side that is looked at") {
        const std::vector<double> strains{2.0, -3.0, 1.0};
        CHECK(worst_triangle(strains, Shading::stretch) == 0);
        CHECK(worst_triangle(strains, Shading::gather) == 1);
        CHECK(worst_triangle(strains, Shading::area) == 1);
    }
}

}  // namespace lastflat
