#include "core/measure/featherline.h"

#include <doctest/doctest.h>

#include <numeric>

#include "tests/helpers/errors.h"
#include "tests/helpers/sample.h"
#include "tests/helpers/shapes.h"

namespace lastflat {
namespace {

const SampleLast& last() {
    static const SampleLast made = make_sample_last();
    return made;
}

FlattenResult with_points(const std::vector<PointSource>& points) {
    FlattenOptions options = test::sample_options(last());
    options.request.points = points;
    return test::flatten_sample(last(), options);
}

const CurveReport& featherline_of(const FlatRegion& flat) {
    return *std::find_if(flat.curves.begin(), flat.curves.end(),
                         [](const CurveReport& c) { return c.name == "featherline"; });
}

}  // namespace

TEST_SUITE("core/measure/featherline") {
    TEST_CASE("the zones of both sides are found, in their order, and add up to the run") {
        const FlattenResult result = with_points({});
        REQUIRE(result.featherlines.size() == 2);
        for (const FeatherlineSide& side : result.featherlines) {
            const FlatRegion& flat = result.regions[side.region];
            CAPTURE(flat.region.name);
            CHECK(side.toe.x() > side.seat.x() + 200);
            CHECK(side.ends[0].name == "toe_end_" + flat.region.name);
            CHECK(side.ends[0].share - side.ends[1].share == doctest::Approx(0.2));
            CHECK(side.ends[2].share == doctest::Approx(0.25));
            const CurveReport& report = featherline_of(flat);
            REQUIRE(report.zones.size() == 4);
            double on_last = 0.0, in_flat = 0.0;
            for (std::size_t z = 0; z < 4; ++z) {
                CHECK(report.zones[z].zone == static_cast<LastZone>(z));
                CHECK(report.zones[z].length_3d_mm > 20.0);
                on_last += report.zones[z].length_3d_mm;
                in_flat += report.zones[z].length_2d_mm;
            }
            CHECK(on_last == doctest::Approx(report.length_3d_mm));
            CHECK(in_flat == doctest::Approx(report.length_2d_mm));
        }
    }

    TEST_CASE("an edge that goes over into another zone counts for each by its share") {
        const Region region =
            test::grid(4, 2, [](double s, double t) { return Vec3(20 * s, 9 * t, 0); });
        Points2 uv;
        for (const Vec3& p : region.positions) uv.emplace_back(1.1 * p.x(), p.y());
        const FeatherlineSide side{
            0,
            {0, 0, 0},
            {20, 0, 0},
            {{{"", {}, 0.6, false}, {"", {}, 0.4, false}, {"", {}, 0.1, false}}}};
        const auto zones = measure_zones(side, region, uv, region.runs[0]);
        const double expected[] = {8.0, 4.0, 6.0, 2.0};
        REQUIRE(zones.size() == 4);
        for (std::size_t z = 0; z < 4; ++z) {
            CHECK(zones[z].length_3d_mm == doctest::Approx(expected[z]));
            CHECK(zones[z].length_2d_mm == doctest::Approx(1.1 * expected[z]));
        }
        CHECK(measure_zones(side, region, uv, region.runs[3]).size() == 1);  // all at the seat
    }

    TEST_CASE("a seat that is wider than the ball is no joint") {
        Region region = test::grid(40, 4, [](double s, double t) {
            const double width = 45 * std::exp(-std::pow((s - 0.15) / 0.1, 2)) +
                                 30 * std::exp(-std::pow((s - 0.7) / 0.1, 2));
            return Vec3(200 * s, -width * (1 - t), 60 * t);
        });
        region.name = "lateral";
        const char* names[] = {"featherline", "centre_front", "topline", "heel"};
        for (std::size_t i = 0; i < 4; ++i) region.runs[i].curve = names[i];
        const auto sides = divide_featherlines({}, {region}, {});
        REQUIRE(sides.size() == 1);
        CHECK(sides[0].ends[0].share == doctest::Approx(0.8).epsilon(0.01));
        CHECK(sides[0].ends[1].share == doctest::Approx(0.6).epsilon(0.01));
    }

    TEST_CASE("the joint lies around the widest place of its side") {
        for (const FeatherlineSide& side : with_points({}).featherlines) {
            const double joint = 0.5 * (side.ends[0].share + side.ends[1].share);
            double widest = 0.0, at_share = 0.0;  // y is to the side, x along the last
            const auto& curves = last().curves;
            const auto featherline = std::find_if(curves.begin(), curves.end(), [](const auto& c) {
                return c.first == "featherline";
            });
            for (const Index v : featherline->second) {
                const Vec3& p = last().mesh.positions[at(v)];
                const double y = side.region == 0 ? -p.y() : p.y();
                if (y <= widest) continue;
                widest = y;
                at_share = (p.x() - side.seat.x()) / (side.toe.x() - side.seat.x());
            }
            CHECK(joint == doctest::Approx(at_share).epsilon(0.03));
        }
    }

    TEST_CASE("where the last lies and how large it is changes no share") {
        SampleLast moved = last();
        for (Vec3& p : moved.mesh.positions) p = 0.4 * Vec3(-p.z(), p.x(), -p.y());
        FlattenOptions options = test::sample_options(moved);
        options.request.weld.unit_mm = 1.0;
        const auto expected = with_points({}).featherlines;
        const auto found = test::flatten_sample(moved, options).featherlines;
        REQUIRE(found.size() == 2);
        for (std::size_t s = 0; s < 2; ++s) {
            for (std::size_t i = 0; i < 3; ++i)
                CHECK(found[s].ends[i].share == doctest::Approx(expected[s].ends[i].share));
        }
    }

    TEST_CASE("a point of the request takes the place of the one that would be found") {
        const auto found = with_points({}).featherlines;
        const Vec3 place = found[0].ends[1].position + Vec3(-12, 0, 0);
        const FlattenResult result = with_points({{"joint_end_lateral", place}});
        const auto& ends = result.featherlines[0].ends;
        CHECK(ends[1].given);
        CHECK((ends[1].position - place).norm() < 4.0);
        CHECK(ends[1].share < found[0].ends[1].share - 0.03);
        CHECK_FALSE(ends[0].given);
        CHECK(ends[0].share == found[0].ends[0].share);
        CHECK(result.featherlines[1].ends[1].share == found[1].ends[1].share);
        const auto before = featherline_of(with_points({}).regions[0]).zones;
        const auto after = featherline_of(result.regions[0]).zones;
        CHECK(after[1].length_3d_mm > before[1].length_3d_mm + 8.0);
        CHECK(after[0].length_3d_mm == before[0].length_3d_mm);
    }

    TEST_CASE("a point may be a vertex; one off the line or out of its order is refused") {
        const auto refused = [&](const PointSource& point) {
            return test::error_of([&] { (void)with_points({point}); });
        };
        CHECK(with_points({{"waist_end_lateral", Index{12}}}).featherlines[0].ends[2].given);
        CHECK(
            test::has(refused({"toe_end_medial", Vec3(100, 0, 90)}), "away from the featherline"));
        CHECK(test::has(refused({"toe_end_medial", last().lateral_vertex}),
                        "away from the featherline"));
        CHECK(test::has(refused({"toe_end_medial", Index{9'999'999}}), "not on the selected"));
        CHECK(test::has(refused({"toe_end_lateral", Index{5}}), "out of its order"));
        CHECK(refused({"vamp_point", Vec3(0, 0, 900)}) == "no error");
    }

    TEST_CASE("where seat or toe is not known there are no zones") {
        FlattenOptions options = test::sample_options(last());
        options.request.cut.regions[0].name = "outside";
        CHECK(test::flatten_sample(last(), options).featherlines.size() == 1);
        options = test::sample_options(last());
        for (CurveSource& curve : options.request.curves) {
            if (curve.name == "heel") curve.name = "back";
        }
        options.request.cut.cuts = {"centre_front", "back"};
        options.request.constraints.pop_back();
        const FlattenResult result = test::flatten_sample(last(), options);
        CHECK(result.featherlines.empty());
        CHECK(featherline_of(result.regions[0]).zones.empty());
    }

    TEST_CASE("a locked featherline has a verdict and no zones") {
        FlattenOptions options = test::sample_options(last());
        options.request.constraints.push_back({Lock{"featherline", Keep::total}});
        const FlattenResult result = test::flatten_sample(last(), options);
        const CurveReport& report = featherline_of(result.regions[0]);
        CHECK(report.verdict == Verdict::pass);
        CHECK(report.zones.empty());
    }
}

}  // namespace lastflat
