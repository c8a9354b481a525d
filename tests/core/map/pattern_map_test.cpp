#include "core/map/pattern_map.h"

#include <doctest/doctest.h>

#include "core/error.h"
#include "core/export/write_model.h"
#include "tests/helpers/sample.h"

namespace lastflat {
namespace {

FlattenResult flat_sample() {
    const SampleLast last = make_sample_last();
    return test::flatten_sample(last, test::sample_options(last));
}

}  // namespace

TEST_SUITE("core/map/pattern_map") {
    TEST_CASE("vertices are exact, and the way there and back ends where it began") {
        const FlattenResult result = flat_sample();
        PatternMap map(read_flat_obj(write_flat_obj(result)));
        double at_vertices = 0.0, there_and_back = 0.0;
        for (const FlatRegion& flat : result.regions) {
            for (std::size_t v = 0; v < flat.region.positions.size(); v += 7) {
                const auto there = map.to_pattern(flat.region.positions[v], flat.region.name);
                at_vertices = std::max(at_vertices, (there.uv - flat.chart.uv[v]).norm());
                const auto back = map.to_last(flat.region.name, flat.chart.uv[v]);
                at_vertices =
                    std::max(at_vertices, (back.position - flat.region.positions[v]).norm());
            }
            for (std::size_t t = 0; t < flat.region.triangles.size(); t += 5) {
                const Triangle& triangle = flat.region.triangles[t];
                const Vec3 inside = 0.2 * flat.region.position(triangle[0]) +
                                    0.3 * flat.region.position(triangle[1]) +
                                    0.5 * flat.region.position(triangle[2]);
                const auto there = map.to_pattern(inside);
                const auto back = map.to_last(there.piece, there.uv);
                CHECK(there.distance < 1e-9);
                there_and_back = std::max(there_and_back, (back.position - inside).norm());
            }
        }
        CHECK(at_vertices < 1e-9);
        CHECK(there_and_back < 1e-6);
    }

    TEST_CASE("how far a point is off is said, and a piece that is not there is refused") {
        const FlattenResult result = flat_sample();
        PatternMap map(read_flat_obj(write_flat_obj(result)));
        const FlatRegion& flat = result.regions.front();
        CHECK(map.to_pattern(flat.region.positions[0] + Vec3(0, 0, 500)).distance > 300.0);
        CHECK(map.to_last(flat.region.name, {9000.0, 0.0}).distance > 8000.0);
        CHECK_THROWS_AS((void)map.to_last("left", {0.0, 0.0}), Error);
        CHECK_THROWS_AS((void)map.to_pattern({0, 0, 0}, "left"), Error);
    }

    TEST_CASE("what is no flat.obj is refused with its line") {
        for (const char* text : {"", "v 0 0 0\n", "g a\nv 0 0 0\nvt 0 0\nf 1/1 2/2 3/3\n", "g a\n",
                                 "g a\nv 0 0\n", "g a\nx 1\n"})
            CHECK_THROWS_AS((void)read_flat_obj(text), Error);
    }
}

}  // namespace lastflat
