#include "core/outline/outline.h"

#include <doctest/doctest.h>

#include "tests/helpers/shapes.h"

namespace lastflat {

TEST_SUITE("core/outline") {
    TEST_CASE("the outline runs counter-clockwise and its segments cover it") {
        const Region region =
            test::grid(4, 3, [](double s, double t) { return Vec3(40 * s, 30 * t, 0); });
        Chart chart;
        for (const Vec3& p : region.positions) chart.uv.push_back(p.head<2>());
        const Outline outline = trace_outline(region, chart);
        REQUIRE(outline.points.size() == 14);
        REQUIRE(outline.segments.size() == 4);
        Index at = outline.segments.front().first;
        CHECK(at == 0);
        for (const OutlineSegment& segment : outline.segments) {
            CHECK(segment.first == at);
            at = segment.last;
        }
        CHECK(at == 0);
        // "right" was given from bottom to top, "top" from left to right: against the border.
        CHECK(outline.segments[2].curve == "top");
        CHECK(outline.points[static_cast<std::size_t>(outline.segments[2].first)] == Vec2(40, 30));
    }

    TEST_CASE("a curve inside the region is no segment") {
        Region region =
            test::grid(4, 3, [](double s, double t) { return Vec3(40 * s, 30 * t, 0); });
        region.runs = {{"inner", {6, 7, 8}}};
        Chart chart;
        for (const Vec3& p : region.positions) chart.uv.push_back(p.head<2>());
        CHECK(trace_outline(region, chart).segments.empty());
    }
}

}  // namespace lastflat
