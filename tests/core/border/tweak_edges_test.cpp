#include "core/border/tweak_edges.h"

#include <doctest/doctest.h>

#include <numbers>

#include "core/error.h"

namespace lastflat {
namespace {

constexpr double quarter = std::numbers::pi / 2;
std::string edge_name(std::size_t i) {
    return "edge " + std::to_string(i);
}

std::vector<double> edge_lengths(const Points2& polygon) {
    std::vector<double> lengths;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        lengths.push_back((polygon[(i + 1) % polygon.size()] - polygon[i]).norm());
    }
    return lengths;
}

}  // namespace

TEST_SUITE("core/border/tweak_edges") {
    TEST_CASE("a rectangle with one side too long is closed as solved by hand") {
        // Sides 5, 2, 3, 2 at right angles miss closure by 2 along x. Least sum of (s/l)^2 with
        // s_0 - s_2 = -2: s_0 = -2 * 25 / (25 + 9), s_2 = 2 * 9 / (25 + 9).
        const auto lengths =
            edge_lengths(tweak_edges({5, 2, 3, 2}, {quarter, quarter, quarter, quarter},
                                     {false, false, false, false}, edge_name));
        CHECK(lengths[0] == doctest::Approx(5.0 - 50.0 / 34.0).epsilon(1e-13));
        CHECK(lengths[1] == doctest::Approx(2.0).epsilon(1e-13));
        CHECK(lengths[2] == doctest::Approx(3.0 + 18.0 / 34.0).epsilon(1e-13));
        CHECK(lengths[3] == doctest::Approx(2.0).epsilon(1e-13));
    }

    TEST_CASE("a locked edge keeps its length and the polygon still closes") {
        const auto lengths =
            edge_lengths(tweak_edges({5, 2, 3, 2}, {quarter, quarter, quarter, quarter},
                                     {true, false, false, false}, edge_name));
        CHECK(lengths[0] == doctest::Approx(5.0).epsilon(1e-13));
        CHECK(lengths[2] == doctest::Approx(5.0).epsilon(1e-13));
    }

    TEST_CASE("a polygon that closes already is left alone") {
        const auto lengths =
            edge_lengths(tweak_edges({4, 1, 4, 1}, {quarter, quarter, quarter, quarter},
                                     {false, false, false, false}, edge_name));
        for (std::size_t i = 0; i < 4; ++i)
            CHECK(lengths[i] == doctest::Approx(i % 2 == 0 ? 4.0 : 1.0).epsilon(1e-13));
    }

    TEST_CASE("too few free edges are an error") {
        const std::vector<double> right_angles(4, quarter);
        CHECK_THROWS_AS(
            (void)tweak_edges({5, 2, 3, 2}, right_angles, {true, true, true, true}, edge_name),
            Error);
        // Only the parallel sides 0 and 2 are free: nothing can close a gap along y.
        CHECK_THROWS_AS(
            (void)tweak_edges({5, 2, 3, 1}, right_angles, {false, true, false, true}, edge_name),
            Error);
    }

    TEST_CASE("an edge that would have to vanish is named") {
        // Along x, the free edge 0 must make up for locked 5 forward and locked 3 back: -2.
        try {
            (void)tweak_edges({1, 5, 2, 3, 2}, {quarter, 0, quarter, quarter, quarter},
                              {false, true, false, true, false}, edge_name);
            FAIL("no error");
        } catch (const Error& error) {
            CHECK(std::string(error.what()).find("1 mm to -2 mm, on edge 0") != std::string::npos);
        }
    }
}

}  // namespace lastflat
