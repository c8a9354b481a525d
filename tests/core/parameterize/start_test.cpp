#include "core/parameterize/start.h"

#include <doctest/doctest.h>

#include "core/border/convex_border.h"
#include "core/numerics/polygon.h"
#include "tests/helpers/shapes.h"

namespace lastflat {
namespace {

constexpr MethodName weighted[] = {
    MethodName::tutte,    MethodName::chord_length, MethodName::shape_preserving,
    MethodName::harmonic, MethodName::wachspress,   MethodName::mean_value};

Start start_of(const Region& region, const MethodOptions& method) {
    return start_chart(region, std::vector<bool>(region.border.size(), false), method);
}

/// A fan of needles: obtuse everywhere, so that cotangents are negative.
Region needles() {
    return test::grid(12, 3, [](double s, double t) {
        return Vec3(100 * s * s, 3 * t + 12 * std::sin(9 * s) * t * (1 - t),
                    25 * t * std::sin(7 * s));
    });
}

}  // namespace

TEST_SUITE("core/parameterize/start") {
    TEST_CASE("every weight works with every border on mild surfaces") {
        for (const Region& region : {test::dome(11, 0.8), test::saddle(10)}) {
            for (const MethodName name : weighted) {
                for (const BorderShape border : {BorderShape::square, BorderShape::circle,
                                                 BorderShape::hull, BorderShape::floating}) {
                    CAPTURE(static_cast<int>(name));
                    CAPTURE(static_cast<int>(border));
                    const Start start = start_of(region, {name, border});
                    CHECK(flipped_triangles(region, start.chart.uv).empty());
                }
            }
            for (const MethodName name : {MethodName::virtual_border, MethodName::geodesic_fan}) {
                CHECK(flipped_triangles(region, start_of(region, {name}).chart.uv).empty());
            }
        }
    }

    TEST_CASE("virtual border and geodesic fan are combinations of weights and a floating border") {
        const Region region = test::saddle(10);
        CHECK(
            test::rigid_difference(
                start_of(region, {MethodName::virtual_border}).chart.uv,
                start_of(region, {MethodName::shape_preserving, BorderShape::floating}).chart.uv) ==
            0.0);
        CHECK(test::rigid_difference(
                  start_of(region, {MethodName::geodesic_fan}).chart.uv,
                  start_of(region, {MethodName::mean_value, BorderShape::floating}).chart.uv) ==
              0.0);
    }

    TEST_CASE("the border has the shape that was asked for") {
        const Region region = test::dome(10, 0.8);
        const auto outline = [&](BorderShape shape) {
            Points2 points;
            const Start start = start_of(region, {MethodName::tutte, shape});
            for (const Index v : region.border)
                points.push_back(start.chart.uv[static_cast<std::size_t>(v)]);
            return points;
        };
        double length = 0;
        for (const double edge : border_lengths(region)) length += edge;
        const double square = signed_area(outline(BorderShape::square));
        CHECK(square == doctest::Approx(length * length / 16).epsilon(0.03));
        const double circle = signed_area(outline(BorderShape::circle));
        CHECK(circle == doctest::Approx(length * length / (4 * 3.14159265)).epsilon(0.01));
        // Both are convex: their hull is no larger.
        for (const BorderShape shape :
             {BorderShape::square, BorderShape::circle, BorderShape::hull}) {
            const Points2 points = outline(shape);
            Points2 hull;
            for (const Index i : convex_hull(points))
                hull.push_back(points[static_cast<std::size_t>(i)]);
            CHECK(signed_area(hull) == doctest::Approx(signed_area(points)).epsilon(1e-12));
        }
    }

    TEST_CASE("an ear on a straight side has room") {
        // The grid's corners are ears: both edges of such a triangle lie on the border.
        for (const BorderShape shape : {BorderShape::square, BorderShape::hull}) {
            for (const Region& region : {test::dome(8, 0.9), test::cylinder(9)}) {
                const Start start = start_of(region, {MethodName::mean_value, shape});
                CHECK(flipped_triangles(region, start.chart.uv).empty());
            }
        }
    }

    TEST_CASE("negative weights are said") {
        const Region region = needles();
        for (const MethodName name : {MethodName::harmonic, MethodName::wachspress}) {
            const Start start = start_of(region, {name});
            REQUIRE(start.warnings.size() == 1);
            CHECK(start.warnings[0].code == "negative_weights");
            CHECK(start.warnings[0].position.has_value());
        }
        CHECK(start_of(region, {MethodName::mean_value}).warnings.empty());
    }
}

}  // namespace lastflat
