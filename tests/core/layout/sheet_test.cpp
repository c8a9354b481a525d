#include "core/layout/sheet.h"

#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include "core/numerics/polygon.h"
#include "tests/helpers/shapes.h"

namespace lastflat {
namespace {

/// The side of a boat: long featherline below, short topline above, leaning heel and front.
Region half(bool other_side) {
    Region region = test::grid(12, 6, [other_side](double s, double t) {
        const double x = 200 * s * (1 - 0.4 * t) + 15 * t;
        return Vec3(x, other_side ? 30.0 : -30.0, 70 * t);
    });
    if (other_side) {
        for (Triangle& t : region.triangles) std::swap(t[1], t[2]);
        find_border(region);
    }
    region.runs[0].curve = "featherline";
    region.runs[1].curve = "centre_front";
    region.runs[2].curve = "topline";
    region.runs[3].curve = "heel";
    region.name = other_side ? "medial" : "lateral";
    return region;
}

/// As seen from outside, then turned by some angle.
Chart view(const Region& region, bool other_side, double angle) {
    Chart chart;
    const Eigen::Rotation2Dd turn(angle);
    for (const Vec3& p : region.positions)
        chart.uv.push_back(turn * Vec2(other_side ? -p.x() : p.x(), p.z()));
    return chart;
}

Points2 placed(const Region& region, const Chart& chart, const Placement& placement) {
    Points2 outline;
    for (const Index v : region.border)
        outline.push_back(placement.apply(chart.uv[static_cast<std::size_t>(v)]));
    return outline;
}

Vec2 position_of(const Chart& chart, const Placement& placement, Index vertex) {
    return placement.apply(chart.uv[static_cast<std::size_t>(vertex)]);
}

/// Whether any edges of the two closed outlines meet.
bool overlap(const Points2& a, const Points2& b) {
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t j = 0; j < b.size(); ++j) {
            const Points2 bow{a[i], a[(i + 1) % a.size()], b[j], b[(j + 1) % b.size()]};
            for (const Crossing& c : self_crossings(bow)) {
                if (c.a == 0 && c.b == 2) return true;
            }
        }
    }
    return false;
}

void check_pair(std::vector<Region> regions, double angle, double other_angle) {
    std::vector<Chart> charts{view(regions[0], false, angle), view(regions[1], true, other_angle)};
    orient_charts(regions, {}, charts);
    CHECK(charts[0].uv[0].norm() == 0.0);  // the seat
    CHECK(charts[1].uv[0].norm() == 0.0);
    const Sheet sheet = arrange_pair(regions, charts, 10.0);
    CHECK(sheet.placements[0].mirrored != sheet.placements[1].mirrored);
    for (std::size_t r = 0; r < 2; ++r) {
        const Placement& p = sheet.placements[r];
        const Vec2 seat = position_of(charts[r], p, 0), toe = position_of(charts[r], p, 12),
                   top = position_of(charts[r], p, 6 * 13 + 6);
        CHECK(toe.x() > seat.x() + 100);
        CHECK(toe.y() == doctest::Approx(seat.y()));
        CHECK(top.y() > seat.y() + 50);
        for (const Vec2& q : placed(regions[r], charts[r], p)) {
            CHECK(q.x() > -1e-9);
            CHECK(q.y() > -1e-9);
            CHECK(q.x() < sheet.width + 1e-9);
            CHECK(q.y() < sheet.height + 1e-9);
        }
    }
    CHECK_FALSE(overlap(placed(regions[0], charts[0], sheet.placements[0]),
                        placed(regions[1], charts[1], sheet.placements[1])));
    CHECK(sheet.width == doctest::Approx(200.0));
    CHECK(sheet.height < 2 * 70 + 11);
}

}  // namespace

TEST_SUITE("core/layout") {
    TEST_CASE("both halves lie the same way up, toe to the right, apart, in a tight rectangle") {
        for (const double angle : {0.0, 1.0, 2.5, -2.0})
            check_pair({half(false), half(true)}, angle, 0.7 - angle);
    }

    TEST_CASE("an arched piece moves down over the one below it") {
        std::vector<Region> regions{half(false), half(true)};
        std::vector<Chart> charts{view(regions[0], false, 0.0), view(regions[1], true, 0.0)};
        for (Chart& chart : charts) {  // up to 30 mm of arch in the middle of the bottom
            for (Vec2& p : chart.uv)
                p.y() += 30 * std::sin(M_PI * std::abs(p.x()) / 200) * (1 - p.y() / 70);
        }
        for (Region& region : regions) {  // shorter above, so that it fits under the arch
            region.runs.clear();
        }
        Points2 narrow;
        for (const Vec2& p : charts[0].uv) narrow.emplace_back(100 + 0.3 * (p.x() - 100), p.y());
        charts[0].uv = narrow;
        const Sheet sheet = arrange_pair(regions, charts, 10.0);
        const double top = placed(regions[0], charts[0], sheet.placements[0])[0].y();
        CHECK(sheet.height < 70 + 70 + 10 - 5);
        CHECK(top >= 0);
        CHECK_FALSE(overlap(placed(regions[0], charts[0], sheet.placements[0]),
                            placed(regions[1], charts[1], sheet.placements[1])));
    }

    TEST_CASE("without named curves the last's long axis takes their place") {
        std::vector<Region> regions{half(false), half(true)};
        for (Region& region : regions) region.runs.clear();
        std::vector<Chart> charts{view(regions[0], false, 0.9), view(regions[1], true, -1.3)};
        orient_charts(regions, {}, charts);
        Eigen::AlignedBox2d box;
        for (const Vec2& p : charts[0].uv) box.extend(p);
        CHECK(box.exteriorDistance(Vec2::Zero()) == 0.0);
        CHECK(std::abs(box.center().x()) < 0.1 * box.sizes().x());
        const Sheet sheet = arrange_pair(regions, charts, 10.0);
        CHECK(sheet.placements[0].mirrored != sheet.placements[1].mirrored);
        const auto toe_to_the_right = [&](std::size_t r) {
            return position_of(charts[r], sheet.placements[r], 12).x() >
                   position_of(charts[r], sheet.placements[r], 0).x();
        };
        CHECK(toe_to_the_right(0) == toe_to_the_right(1));
    }
}

}  // namespace lastflat
