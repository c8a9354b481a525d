#include "core/parameterize/weights.h"

#include <doctest/doctest.h>

#include <numbers>
#include <numeric>

#include "core/border/convex_border.h"
#include "core/parameterize/fixed_border.h"
#include "tests/helpers/shapes.h"

namespace lastflat {
namespace {

/// A flat star around the origin, its neighbours at these polar coordinates.
Star flat_star(const std::vector<std::pair<double, double>>& polar) {
    Star star;
    for (std::size_t j = 0; j < polar.size(); ++j) {
        star.neighbours.push_back(static_cast<Index>(j));
        star.distances.push_back(polar[j].second);
        const double next =
            j + 1 < polar.size() ? polar[j + 1].first : polar[0].first + 2 * std::numbers::pi;
        star.angles.push_back(next - polar[j].first);
    }
    return star;
}

/// Where the weighted mean of the neighbours lies; the star's centre is the origin.
Vec2 weighted_mean(const std::vector<std::pair<double, double>>& polar,
                   const std::vector<double>& weights) {
    Vec2 sum = Vec2::Zero();
    double total = 0;
    for (std::size_t j = 0; j < polar.size(); ++j) {
        sum +=
            weights[j] * polar[j].second * Vec2(std::cos(polar[j].first), std::sin(polar[j].first));
        total += weights[j];
    }
    return sum / total;
}

const std::vector<std::pair<double, double>> convex{{0.1, 1.0}, {1.2, 1.3}, {2.3, 1.1},
                                                    {3.4, 0.9}, {4.4, 1.2}, {5.3, 1.0}};
const std::vector<std::pair<double, double>> concave{{0.1, 3.0}, {1.2, 0.4}, {2.3, 2.5},
                                                     {3.4, 0.5}, {4.4, 2.0}, {5.3, 1.0}};

}  // namespace

TEST_SUITE("core/parameterize/weights") {
    TEST_CASE("a flat star's centre is the weighted mean of its neighbours") {  // linear precision
        for (const auto& polar : {convex, concave}) {
            for (const WeightRule rule : {shape_preserving_weights, harmonic_weights,
                                          wachspress_weights, mean_value_weights}) {
                CHECK(weighted_mean(polar, rule(flat_star(polar))).norm() < 1e-12);
            }
            // The two that do not reproduce a plane, so that this test can tell.
            CHECK(weighted_mean(polar, tutte_weights(flat_star(polar))).norm() > 1e-3);
            CHECK(weighted_mean(polar, chord_length_weights(flat_star(polar))).norm() > 1e-3);
        }
    }

    TEST_CASE("the rules that promise it are positive, the others need not be") {
        for (const auto& polar : {convex, concave}) {
            for (const WeightRule rule : {tutte_weights, chord_length_weights,
                                          shape_preserving_weights, mean_value_weights}) {
                for (const double weight : rule(flat_star(polar))) CHECK(weight > 0);
            }
        }
        const auto least = [](const std::vector<double>& w) {
            return *std::min_element(w.begin(), w.end());
        };
        CHECK(least(harmonic_weights(flat_star(concave))) < 0);
        CHECK(least(wachspress_weights(flat_star(concave))) < 0);
        CHECK(least(wachspress_weights(flat_star(convex))) > 0);
    }

    TEST_CASE("known values: a square around its centre, spokes of two lengths") {
        const double quarter = std::numbers::pi / 2;
        const Star star =
            flat_star({{0, 1.0}, {quarter, 2.0}, {2 * quarter, 1.0}, {3 * quarter, 2.0}});
        const auto ratio = [&](WeightRule rule) {
            const auto w = rule(star);
            CHECK(w[0] == doctest::Approx(w[2]));
            CHECK(w[1] == doctest::Approx(w[3]));
            return w[0] / w[1];
        };
        CHECK(ratio(tutte_weights) == doctest::Approx(1));
        CHECK(ratio(chord_length_weights) == doctest::Approx(2));
        CHECK(ratio(mean_value_weights) == doctest::Approx(2));
        CHECK(ratio(harmonic_weights) == doctest::Approx(4));    // cotangents 2 and 1/2
        CHECK(ratio(wachspress_weights) == doctest::Approx(1));  // (1/2 + 1/2) / 1, (2 + 2) / 4
        CHECK(ratio(shape_preserving_weights) == doctest::Approx(1));
    }

    TEST_CASE("on a surface the shape preserving star is scaled to go round once") {
        // Five equal spokes at 60 degrees: a pyramid's tip. All weights are equal by symmetry.
        Star star;
        for (Index j = 0; j < 5; ++j) {
            star.neighbours.push_back(j);
            star.distances.push_back(1.0);
            star.angles.push_back(std::numbers::pi / 3);
        }
        for (const double weight : shape_preserving_weights(star)) {
            CHECK(weight == doctest::Approx(0.2));
        }
    }

    TEST_CASE("a star whose centre lies in no triangle has positive shape preserving weights") {
        Star star{{0, 1, 2}, {1.0, 2.0, 1.5}, {3.5, 1.4, 1.383}};  // one angle above pi
        for (const double weight : shape_preserving_weights(star)) CHECK(weight > 0);
    }

    TEST_CASE("positive rules never flip a triangle inside a strictly convex border") {
        for (const Region& region : {test::dome(14, 1.4), test::saddle(15), test::cone(9)}) {
            for (const WeightRule rule : {tutte_weights, chord_length_weights,
                                          shape_preserving_weights, mean_value_weights}) {
                const Chart chart = flatten_fixed_border(region, rule, circle_border(region));
                CHECK(flipped_triangles(region, chart.uv).empty());
            }
        }
    }
}

}  // namespace lastflat
