#include "core/parameterize/fixed_border.h"

#include <doctest/doctest.h>

#include "core/border/convex_border.h"
#include "tests/helpers/shapes.h"

namespace lastflat {
namespace {

Points2 flat_border(const Region& region) {
    Points2 border;
    for (const Index v : region.border)
        border.emplace_back(region.position(v).x(), region.position(v).y());
    return border;
}

}  // namespace

TEST_SUITE("core/parameterize/fixed_border") {
    TEST_CASE("a flat region keeps its shape when its border is given") {  // linear precision
        const Region region = test::plane(10);
        const Chart chart = flatten_fixed_border(region, mean_value_weights, flat_border(region));
        double largest = 0;
        for (std::size_t v = 0; v < chart.uv.size(); ++v) {
            largest = std::max(largest, (chart.uv[v] - region.positions[v].head<2>()).norm());
        }
        CHECK(largest < 1e-11);
    }

    TEST_CASE("a strictly convex border never flips a triangle") {
        for (const Region& region : {test::dome(14, 1.4), test::saddle(15), test::cone(9)}) {
            CHECK(flipped_triangles(
                      region,
                      flatten_fixed_border(region, mean_value_weights, circle_border(region)).uv)
                      .empty());
        }
    }

    TEST_CASE("an inner vertex lies inside the hull of its neighbours' mean") {
        // One inner vertex, six equal neighbours: the weights are equal, so it is the centroid.
        Region region;
        region.positions.push_back(Vec3::Zero());
        for (int i = 0; i < 6; ++i) {
            region.positions.emplace_back(std::cos(i * M_PI / 3), std::sin(i * M_PI / 3), 0.0);
            region.triangles.push_back(
                {0, static_cast<Index>(1 + i), static_cast<Index>(1 + (i + 1) % 6)});
        }
        find_border(region);
        Points2 border;
        Vec2 mean = Vec2::Zero();
        for (std::size_t i = 0; i < 6; ++i) {
            border.emplace_back(3.0 * std::cos(1.0 * static_cast<double>(i)),
                                2.0 * std::sin(1.0 * static_cast<double>(i)));
            mean += border.back() / 6.0;
        }
        CHECK((flatten_fixed_border(region, mean_value_weights, border).uv[0] - mean).norm() <
              1e-14);
    }
}

}  // namespace lastflat
