#include "core/measure/check_result.h"

#include <doctest/doctest.h>

#include "tests/helpers/errors.h"
#include "tests/helpers/shapes.h"

namespace lastflat {
namespace {

std::vector<Warning> warned(const Region& region, double scale) {
    Points2 uv;
    for (const Vec3& p : region.positions) uv.emplace_back(scale * p.x(), p.y());
    std::vector<Warning> warnings;
    check_distortion(region, measure_distortion(region, uv), measure_stretch(region, uv, {}), false,
                     warnings);
    return warnings;
}

}  // namespace

TEST_SUITE("core/measure/check_result") {
    TEST_CASE("a pattern that no leather follows is told, by its strain or its energy") {
        const Region plane = test::plane();
        CHECK(warned(plane, 1.0).empty());
        CHECK(warned(plane, 1.09).empty());
        const auto small = warned(plane, 0.78);  // 28 % of stretch
        REQUIRE(small.size() == 1);
        CHECK(small[0].code == "distortion_extreme");
        CHECK(small[0].position.has_value());
        CHECK(warned(plane, 1.4).size() == 1);
    }

    TEST_CASE("where the toe is known, less strain is borne behind it") {
        const Region plane = test::plane();
        double least = 1e9, most = -1e9;
        for (const Vec3& p : plane.positions) {
            least = std::min(least, p.x());
            most = std::max(most, p.x());
        }
        FeatherlineSide side{};
        side.seat = {least, 0.0, 0.0};
        side.toe = {most, 0.0, 0.0};
        side.ends[0].share = 0.5;
        const double end = 0.5 * (least + most);
        const auto warnings_of = [&](bool behind, const std::optional<FeatherlineSide>& known) {
            Points2 uv;  // 15 % of stretch on one half
            for (const Vec3& p : plane.positions)
                uv.emplace_back((p.x() < end) == behind ? end + 0.87 * (p.x() - end) : p.x(),
                                p.y());
            const auto metrics = measure_distortion(plane, uv);
            CHECK(metrics.symmetric_dirichlet < 1.02);
            std::vector<Warning> warnings;
            check_distortion(plane, metrics, measure_stretch(plane, uv, {}, known), false,
                             warnings);
            return warnings;
        };
        CHECK(warnings_of(true, std::nullopt).empty());
        CHECK(warnings_of(false, side).empty());
        REQUIRE(warnings_of(true, side).size() == 1);
        CHECK(warnings_of(true, side)[0].detail.find("behind the toe by 15 %") !=
              std::string::npos);
    }

    TEST_CASE("the cause is the border where it is too short, and the shape where it is not") {
        CHECK(warned(test::plane(), 0.7).at(0).detail.find("bends more") != std::string::npos);
        const Region cup = test::grid(16, 16, [](double s, double t) {
            return Vec3(60 * s, 60 * t, 2000 * s * (1 - s) * t * (1 - t));
        });
        REQUIRE(warned(cup, 1.0).size() == 1);
        CHECK(warned(cup, 1.0)[0].detail.find("too short") != std::string::npos);
    }

    TEST_CASE("what was found without a request is refused instead") {
        const Region plane = test::plane();
        Points2 uv;
        for (const Vec3& p : plane.positions) uv.emplace_back(0.7 * p.x(), p.y());
        std::vector<Warning> warnings;
        CHECK(test::has(test::error_of([&] {
                            check_distortion(plane, measure_distortion(plane, uv),
                                             measure_stretch(plane, uv, {}), true, warnings);
                        }),
                        "distortion_extreme"));
        CHECK(warnings.empty());
    }
}

}  // namespace lastflat
