#include "core/parameterize/floating_border.h"

#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include "core/constrain/scale_to_locks.h"
#include "tests/helpers/shapes.h"

namespace lastflat {
namespace {

Chart fan(const Region& region, AngleRule rule = AngleRule::curvature) {
    const std::vector<bool> free(region.border.size(), false);
    const Dissection dissection = dissection_of(region.positions, region.half_edges);
    return scaled_to_locks(region,
                           flatten_floating_border(region, dissection, mean_value_weights,
                                                   border_polygon(region, dissection, free, rule)),
                           {});
}

}  // namespace

TEST_SUITE("core/parameterize/floating_border") {
    TEST_CASE("no triangle flips on curved regions, under either rule of angles") {
        for (const Region& region : {test::dome(), test::saddle(), test::cone(), test::plane()}) {
            CHECK(flipped_triangles(region, fan(region).uv).empty());
            CHECK(flipped_triangles(region, fan(region, AngleRule::averaged_conformal).uv).empty());
        }
    }

    TEST_CASE("a flat convex region comes back nearly unchanged") {
        // Not exactly: the virtual layer pulls at the border (reading of the paper, C).
        const Region region =
            test::grid(12, 12, [](double s, double t) { return Vec3(90 * s, 70 * t, 0); });
        CHECK(test::worst_edge_change(region, fan(region).uv) < 0.05);
    }

    TEST_CASE("turning and moving the region changes nothing") {
        const Region region = test::saddle();
        Region moved = region;
        const Eigen::Matrix3d turn =
            Eigen::AngleAxisd(1.1, Vec3(1, 2, -1).normalized()).toRotationMatrix();
        for (Vec3& p : moved.positions) p = turn * p + Vec3(100, -20, 7);
        CHECK(test::rigid_difference(fan(region).uv, fan(moved).uv) < 1e-9);
    }

    TEST_CASE("scaling the region scales the chart") {
        const Region region = test::saddle();
        Region larger = region;
        for (Vec3& p : larger.positions) p *= 10;
        Points2 scaled = fan(region).uv;
        for (Vec2& p : scaled) p *= 10;
        CHECK(test::rigid_difference(scaled, fan(larger).uv) < 1e-8);
    }
}

}  // namespace lastflat
