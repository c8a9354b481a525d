#include "core/flatten.h"

#include <doctest/doctest.h>

#include <set>

#include "core/border/convex_border.h"
#include "core/constrain/minimise_distortion.h"
#include "core/layout/base_line.h"
#include "core/parameterize/start.h"
#include "tests/helpers/minimum.h"
#include "tests/helpers/sample.h"
#include "tests/helpers/shapes.h"

namespace lastflat {
namespace {

void check_certificate(const FlattenResult& result) {
    for (const FlatRegion& flat : result.regions) {
        CAPTURE(flat.region.name);
        CHECK(flat.metrics.flipped_triangles == 0);
        CHECK(flat.metrics.border_crossings == 0);
        CHECK(flat.metrics.symmetric_dirichlet < 1.002);
        CHECK_FALSE(flat.metrics.area_verdict.has_value());
        for (const CurveReport& curve : flat.curves) {
            CHECK(curve.verdict.has_value() == curve.locked);
            if (curve.locked) CHECK(curve.worst_edge_error_mm < 1e-9);
        }
    }
    for (const PairReport& pair : result.pairs) CHECK(std::abs(pair.difference_mm) < 1e-9);
}

}  // namespace

TEST_SUITE("core/flatten") {
    TEST_CASE("the sample last comes out whole, in every size and shape") {
        for (const SampleLastOptions& options :
             {SampleLastOptions{}, SampleLastOptions{36, 60, 4, -5, ToeShape::pointed},
              SampleLastOptions{46, 0, 12, 8, ToeShape::square}}) {
            const SampleLast last = make_sample_last(options);
            const FlattenResult result = test::flatten_sample(last, test::sample_options(last));
            REQUIRE(result.regions.size() == 2);
            CHECK(result.warnings.empty());
            CHECK(result.pairs.size() == 2);
            CHECK(result.sheet.placements[0].mirrored == false);
            CHECK(result.sheet.placements[1].mirrored == true);
            check_certificate(result);
        }
    }

    TEST_CASE("one and two threads give the same bits") {
        const SampleLast last = make_sample_last();
        FlattenOptions options = test::sample_options(last);
        const FlattenResult one = test::flatten_sample(last, options);
        options.threads = 2;
        const FlattenResult two = test::flatten_sample(last, options);
        for (std::size_t r = 0; r < 2; ++r)
            CHECK(one.regions[r].chart.uv == two.regions[r].chart.uv);
    }

    TEST_CASE("a last in another place and unit gives the same pattern") {
        const SampleLast last = make_sample_last();
        const FlattenResult expected = test::flatten_sample(last, test::sample_options(last));
        SampleLast moved = last;
        for (Vec3& p : moved.mesh.positions) p = Vec3(-p.y(), p.x(), p.z()) + Vec3(500, 0, 20);
        FlattenOptions options = test::sample_options(last);
        const FlattenResult found = test::flatten_sample(moved, options);
        for (std::size_t r = 0; r < 2; ++r) {
            double largest = 0;
            for (std::size_t v = 0; v < expected.regions[r].chart.uv.size(); ++v) {
                largest = std::max(
                    largest,
                    (expected.regions[r].chart.uv[v] - found.regions[r].chart.uv[v]).norm());
            }
            CHECK(largest < 1e-6);
        }
    }

    TEST_CASE("methods without locks report what they leave, after one uniform scale") {
        const SampleLast last = make_sample_last();
        FlattenOptions options = test::sample_options(last);
        for (const MethodName method :
             {MethodName::tutte, MethodName::chord_length, MethodName::shape_preserving,
              MethodName::mean_value, MethodName::virtual_border, MethodName::geodesic_fan,
              MethodName::mips}) {
            options.request.method.name = method;
            const FlattenResult result = test::flatten_sample(last, options);
            for (const FlatRegion& flat : result.regions) {
                double in_space = 0, flat_sum = 0;
                for (const CurveReport& curve : flat.curves) {
                    if (!curve.locked) continue;
                    in_space += curve.length_3d_mm;
                    flat_sum += curve.length_2d_mm;
                    CHECK(curve.verdict == Verdict::fail);
                }
                CHECK(flat_sum == doctest::Approx(in_space).epsilon(1e-12));
                CHECK(flat.metrics.flipped_triangles == 0);
            }
        }
    }

    TEST_CASE("a map that folds is an error that names its triangles, never a result") {
        // Slanted needles: cotangents are negative, and the harmonic map folds.
        const Region region = test::grid(14, 4, [](double s, double t) {
            return Vec3(100 * s + 160 * t, 6 * t, 12 * std::sin(5 * s) * t);
        });
        RawMesh mesh;
        mesh.positions = region.positions;
        mesh.triangles = region.triangles;
        mesh.label_sets = {{"all"}};
        mesh.triangle_labels.assign(mesh.triangles.size(), 0);
        FlattenOptions options;
        options.request.method = {MethodName::harmonic, BorderShape::circle};
        Progress progress;
        try {
            (void)flatten(write_model_obj(mesh), options, progress);
            FAIL("no error");
        } catch (const Error& error) {
            CHECK(error.code() == ErrorCode::method_failed);
            REQUIRE(!error.triangles().empty());
            CHECK(error.position().has_value());
            for (const Index v : error.triangles().front()) {
                CHECK(v < static_cast<Index>(mesh.positions.size()));
            }
        }
    }

    TEST_CASE(
        "the fan is made when it is asked for, its angles are the chart's; nothing else changes") {
        const SampleLast last = make_sample_last();
        FlattenOptions options = test::sample_options(last);
        const FlattenResult without = test::flatten_sample(last, options);
        options.request.include_fan = true;
        const FlattenResult result = test::flatten_sample(last, options);
        for (std::size_t r = 0; r < result.regions.size(); ++r) {
            const FlatRegion& flat = result.regions[r];
            CHECK_FALSE(without.regions[r].fan);
            CHECK(without.regions[r].chart.uv == flat.chart.uv);
            CHECK(flat.chart.uv[at(named_base_line(flat.region)->seat)].norm() == 0.0);
            REQUIRE(flat.fan);
            const Vec2 centre = flat.chart.uv[at(flat.fan->centre)];
            CHECK(flat.fan->mean_distance < flat.fan->radius);
            CHECK(flat.fan->spokes.size() == flat.region.border.size());
            // A last is nearly developable: polar coordinates of the surface and of the chart
            // nearly agree.
            for (std::size_t i = 0; i < flat.fan->spokes.size(); ++i) {
                const Vec2 p = flat.chart.uv[at(flat.region.border[i])] - centre;
                const FanSpoke& spoke = flat.fan->spokes[i];
                CHECK(std::abs(spoke.distance / p.norm() - 1) < 0.06);
                CHECK(std::abs(std::remainder(spoke.angle - std::atan2(p.y(), p.x()),
                                              6.283185307179586)) < 0.2);
            }
        }
    }

    TEST_CASE("a region beyond the bound has no fan, and a warning says so") {
        const SampleLast last = make_sample_last();
        FlattenOptions options = test::sample_options(last);
        options.request.draw_fan = true;
        CHECK(test::flatten_sample(last, options).regions[0].fan.has_value());
        options.fan_triangles = 100;
        const FlattenResult refused = test::flatten_sample(last, options);
        CHECK(!refused.regions[0].fan);
        REQUIRE(refused.warnings.size() == 2);
        CHECK(refused.warnings[0].code == "no_fan");
    }

    TEST_CASE("a start that fails is replaced, and a warning says so") {
        // Every border edge locked: the fan's polygon cannot close. On a developable patch the
        // locks can hold all the same, so the circle must lead there.
        const Region region = test::cylinder(8);
        const std::vector<bool> all(region.border.size(), true);
        const Start start = start_chart(region, all, {});
        REQUIRE(start.warnings.size() == 1);
        CHECK(start.warnings[0].code == "start_replaced");
        CHECK(flipped_triangles(region, start.chart.uv).empty());
        const std::vector<Constraint> locks{lock("bottom"), lock("right"), lock("top"),
                                            lock("left")};
        const Minimum minimum = test::minimised(region, start.chart, locks);
        CHECK(minimum.energy == doctest::Approx(1.0).epsilon(1e-10));
    }

    TEST_CASE("a pin that gave way does not move the chart from the one that holds") {
        const SampleLast last = make_sample_last();
        FlattenOptions options = test::sample_options(last);
        options.request.on_conflict = OnConflict::relax;
        const FlattenResult free = test::flatten_sample(last, options);
        const Region& region = free.regions[0].region;
        const auto run = std::find_if(region.runs.begin(), region.runs.end(),
                                      [](const CurveRun& r) { return r.curve == "centre_front"; });
        REQUIRE(run != region.runs.end());
        for (const Index end : {run->vertices.front(), run->vertices.back()}) {
            // Further apart than the locked curve is long.
            const int priority = options.request.constraints.size() == 2 ? 1 : -1;
            const Pin pin{region.source_vertices[at(end)], Vec2(500.0 * priority, 7.0),
                          region.name};
            options.request.constraints.push_back({pin, priority});
        }
        const FlattenResult result = test::flatten_sample(last, options);
        std::size_t relaxed = 0;
        for (const ConstraintReport& report : result.constraints) {
            CHECK(report.kept == !report.relaxed);
            if (report.relaxed) {
                CHECK(report.constraint == 3);
                ++relaxed;
            }
        }
        CHECK(relaxed == 1);
    }

    TEST_CASE("a lock on a curve that is not there is an error at its field") {
        const SampleLast last = make_sample_last();
        FlattenOptions options = test::sample_options(last);
        options.request.constraints.push_back(lock("collar"));
        options.request.constraints.back().option = {"locks", "2"};
        try {
            (void)test::flatten_sample(last, options);
            FAIL("no error");
        } catch (const Error& error) {
            CHECK(error.option() == std::vector<std::string>{"locks", "2", "curve"});
        }
    }

    TEST_CASE("a canceled job ends with that error") {
        const SampleLast last = make_sample_last();
        Progress progress;
        progress.cancel();
        try {
            (void)flatten(write_model_obj(last.mesh), test::sample_options(last), progress);
            FAIL("no error");
        } catch (const Error& error) {
            CHECK(error.code() == ErrorCode::canceled);
        }
    }

    TEST_CASE("progress goes forward and ends at one") {
        const SampleLast last = make_sample_last();
        std::vector<std::pair<Stage, double>> steps;
        Progress progress(
            [&](Stage stage, double fraction) { steps.emplace_back(stage, fraction); });
        (void)flatten(write_model_obj(last.mesh), test::sample_options(last), progress);
        REQUIRE(steps.size() > 5);
        CHECK(steps.front().second >= 0.0);
        std::set<Stage> stages;
        for (std::size_t i = 0; i < steps.size(); ++i) {
            stages.insert(steps[i].first);
            if (i == 0) continue;
            CAPTURE(i);
            CHECK(steps[i].first >= steps[i - 1].first);
            CHECK(steps[i].second >= steps[i - 1].second);
        }
        CHECK(stages.size() == static_cast<std::size_t>(Stage::done) + 1);
        CHECK(steps.back() == std::pair(Stage::done, 1.0));
        CHECK(progress.stage() == Stage::done);
        CHECK(progress.fraction() == 1.0);
    }
}

}  // namespace lastflat
