#include "core/session/session.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "core/export/write_model.h"
#include "core/session/carry_chart.h"
#include "tests/helpers/errors.h"
#include "tests/helpers/sample.h"

namespace lastflat {
namespace {

/// A pin where the vertex lies now.
Constraint pin(const FlattenResult& pattern, std::size_t at_border) {
    const FlatRegion& flat = pattern.regions[0];
    const Index v = flat.region.border[at_border];
    const auto id = pattern.sources.file_vertex(flat.region.source_vertices[at(v)]);
    return {Pin{id.value(), flat.chart.uv[at(v)], flat.region.name}};
}

struct Opened {
    SampleLast last = make_sample_last();
    FlattenOptions options = test::sample_options(last);
    Progress progress{};
    Session session{write_model_obj(last.mesh), options, progress};

    Reach change() { return session.change(options.request, progress); }
    [[nodiscard]] const FlatRegion& lateral() const { return session.pattern().regions[0]; }
    /// Where they lie; the next change tells the session.
    void pin_two() {
        const std::size_t border = lateral().region.border.size();
        for (const std::size_t share : {1u, 3u})
            options.request.constraints.push_back(pin(session.pattern(), border * share / 8));
    }
};

const std::vector<Index>& vertices_of(const SampleLast& last, const std::string& curve) {
    return std::find_if(last.curves.begin(), last.curves.end(),
                        [&](const auto& named) { return named.first == curve; })
        ->second;
}

double largest_change(const std::vector<Points2>& before, const FlattenResult& pattern) {
    double most = 0.0;
    for (std::size_t r = 0; r < before.size(); ++r) {
        for (std::size_t v = 0; v < before[r].size(); ++v)
            most = std::max(most, (before[r][v] - pattern.regions[r].chart.uv[v]).norm());
    }
    return most;
}

std::vector<Points2> charts(const FlattenResult& pattern) {
    std::vector<Points2> uv;
    for (const FlatRegion& flat : pattern.regions) uv.push_back(flat.chart.uv);
    return uv;
}

}  // namespace

TEST_SUITE("core/session") {
    TEST_CASE("it begins with the pattern that a job gives") {
        const Opened opened;
        const FlattenResult job = test::flatten_sample(opened.last, opened.options);
        for (std::size_t r = 0; r < 2; ++r)
            CHECK(opened.session.pattern().regions[r].chart.uv == job.regions[r].chart.uv);
    }

    TEST_CASE("a dragged pin ends where a job puts it, in few steps") {
        Opened opened;
        auto& constraints = opened.options.request.constraints;
        opened.pin_two();
        CHECK(opened.change() == Reach::pattern);
        for (int step = 0; step < 5; ++step) {
            std::get<Pin>(constraints.back().demand).at += Vec2(0.0, 0.2);
            CHECK(opened.change() == Reach::pattern);
            CHECK(opened.lateral().iterations <= 8);
        }
        CHECK(opened.session.difference_from_job(opened.progress) < 1e-5);
        CHECK(opened.session.pattern().constraints.size() == 6);
    }

    TEST_CASE("once it has settled, the next change is as near as with a factor of its own") {
        Opened opened;
        auto& constraints = opened.options.request.constraints;
        opened.pin_two();
        opened.change();
        int unsettled = 0, settled = 0, canceled_ones = 0;
        Progress canceled;
        canceled.cancel();
        for (int step = 0; step < 6; ++step) {
            std::get<Pin>(constraints.back().demand).at += Vec2(0.0, 0.4);
            opened.change();
            (step < 3 ? unsettled : settled) += opened.lateral().iterations;
            if (step < 2) continue;
            const auto end = test::error_of([&] { opened.session.settle(canceled); });
            canceled_ones += test::has(end, "canceled") ? 1 : 0;
            opened.session.settle(opened.progress);
            opened.session.settle(canceled);  // there is nothing left to be done
        }
        CHECK(settled <= unsettled);
        CHECK(canceled_ones > 0);
        CHECK(opened.session.difference_from_job(opened.progress) < 1e-5);
    }

    TEST_CASE("locks come and go, weights change, and the optimum is that of a job") {
        Opened opened;
        Request& request = opened.options.request;
        const auto before = charts(opened.session.pattern());
        request.constraints.pop_back();
        CHECK(opened.change() == Reach::pattern);
        CHECK(largest_change(before, opened.session.pattern()) > 1e-4);
        CHECK(opened.session.difference_from_job(opened.progress) < 1e-5);
        request.constraints.push_back(lock("heel"));
        request.weights.stretch = 3.0;
        CHECK(opened.change() == Reach::pattern);
        CHECK(opened.session.difference_from_job(opened.progress) < 1e-5);
        request.weights.stretch = 1.0;
        CHECK(opened.change() == Reach::pattern);
        CHECK(largest_change(before, opened.session.pattern()) < 1e-5);
    }

    TEST_CASE("a range that holds is let go, one that does not is held") {
        Opened opened;
        Request& request = opened.options.request;
        request.constraints.push_back(range("featherline", -2.0, -1.5));
        CHECK(opened.change() == Reach::pattern);
        CHECK(opened.session.difference_from_job(opened.progress) < 1e-5);
        request.constraints.back() = range("featherline", -2.0, 2.0);
        CHECK(opened.change() == Reach::pattern);
        CHECK(opened.session.difference_from_job(opened.progress) < 1e-5);
    }

    TEST_CASE("what cannot be met leaves the session as it was") {
        Opened opened;
        Request& request = opened.options.request;
        const auto before = charts(opened.session.pattern());
        const Request good = request;
        request.constraints.push_back(range("heel", 5.0, 6.0));
        CHECK(test::has(test::error_of([&] { opened.change(); }), "constraints_infeasible"));
        CHECK(charts(opened.session.pattern()) == before);
        request = good;
        CHECK(opened.change() == Reach::nothing);
        request.curves.push_back({"line", Polyline{{Vec3(0, 0, 0), Vec3(900, 900, 900)}}});
        CHECK(test::has(test::error_of([&] { opened.change(); }), "curve_invalid"));
        CHECK(opened.session.curves().empty());
    }

    TEST_CASE("a canceled change leaves it as it was, and the next one works") {
        Opened opened;
        auto& constraints = opened.options.request.constraints;
        constraints.pop_back();
        Progress canceled;
        canceled.cancel();
        const auto before = charts(opened.session.pattern());
        CHECK(test::has(
            test::error_of([&] { (void)opened.session.change(opened.options.request, canceled); }),
            "canceled"));
        CHECK(charts(opened.session.pattern()) == before);
        CHECK(opened.change() == Reach::pattern);
        CHECK(opened.session.difference_from_job(opened.progress) < 1e-5);
    }

    TEST_CASE("a curve that is only shown is mapped, over a cut too, and moves nothing") {
        Opened opened;
        const auto before = charts(opened.session.pattern());
        auto& curves = opened.options.request.curves;
        const auto& vertices = vertices_of(opened.last, "centre_front");
        const Index ridge = vertices[vertices.size() / 2];
        const Vec3 top = opened.last.mesh.positions[at(ridge)];
        curves.push_back({"line", Polyline{{top + Vec3(0, 15, -4), top, top + Vec3(0, -15, -4)}}});
        CHECK(opened.change() == Reach::curves);
        CHECK(charts(opened.session.pattern()) == before);
        REQUIRE(opened.session.curves().size() == 1);
        const ShownCurve& shown = opened.session.curves().front();
        CHECK(shown.runs.size() == 2);
        CHECK(shown.length_3d > 25.0);
        CHECK(shown.length_2d == doctest::Approx(shown.length_3d).epsilon(0.02));
        std::get<Polyline>(curves.back().form).points.front().x() += 2.0;
        CHECK(opened.change() == Reach::curves);
        CHECK(opened.session.map().to_pattern(top).distance < 1e-9);
    }

    TEST_CASE("a cut that moves starts from the charts before, and ends where a job does") {
        Opened opened;
        Request& request = opened.options.request;
        const auto find = [&](const std::string& name) {
            return std::find_if(request.curves.begin(), request.curves.end(),
                                [&](const CurveSource& curve) { return curve.name == name; });
        };
        Polyline drawn;
        for (const Index v : vertices_of(opened.last, "heel"))
            drawn.points.push_back(opened.last.mesh.positions[at(v)]);
        for (std::size_t i = 1; i + 1 < drawn.points.size(); ++i) drawn.points[i].y() += 0.8;
        find("heel")->form = drawn;
        CHECK(opened.change() == Reach::regions);
        CHECK(opened.session.difference_from_job(opened.progress) < 1e-4);
    }

    TEST_CASE("another unit is another model") {
        Opened opened;
        opened.options.request.weld.groups = {"upper", "sole"};
        CHECK_THROWS_AS(opened.change(), Error);
        opened.options.request.weld.groups = {"upper"};
        CHECK(opened.change() == Reach::nothing);
    }

    TEST_CASE("a chart carried to its own region is that chart") {
        const Opened opened;
        const FlatRegion& flat = opened.lateral();
        const auto carried = carried_chart(flat.region, flat.chart, flat.region);
        REQUIRE(carried);
        for (std::size_t v = 0; v < flat.chart.uv.size(); ++v)
            CHECK((carried->uv[v] - flat.chart.uv[v]).norm() < 1e-9);
    }
}

}  // namespace lastflat
