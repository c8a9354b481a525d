#include "core/constrain/closure.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <numbers>

#include "tests/helpers/constraints.h"
#include "tests/helpers/shapes.h"

namespace lastflat {
namespace {

Constraint straight(const std::string& curve, const std::string& region = "") {
    return {Straight{curve, region}};
}

Constraint pin(Index vertex, const Vec2& at) {
    return {Pin{vertex, at}};
}

Constraint area(double percent) {
    return {TotalArea{percent, percent}};
}

std::optional<OpenLoop> found(const std::vector<const Region*>& regions,
                              const std::vector<Constraint>& constraints) {
    const Domain domain(regions);
    return open_loop(domain, constraint_rows(domain, constraints), constraints);
}

std::optional<OpenLoop> found(const Region& region, const std::vector<Constraint>& constraints) {
    return found({&region}, constraints);
}

/// 100 mm wide, 30 mm high.
Region rectangle() {
    return test::grid(10, 3, [](double s, double t) { return Vec3(100 * s, 30 * t, 0); });
}

/// A square of 20 mm whose middle, vertex 4, is raised; it has eight neighbours.
Region pyramid(double height) {
    return test::grid(2, 2, [height](double s, double t) {
        return Vec3(20 * s, 20 * t, s == 0.5 && t == 0.5 ? height : 0.0);
    });
}

/// Every triangle around the vertex, locked by a curve of its own.
std::vector<Constraint> locked_neighbourhood(Region& region, Index centre,
                                             Keep keep = Keep::edges) {
    std::vector<Constraint> constraints;
    for (const Triangle& t : region.triangles) {
        if (std::find(t.begin(), t.end(), centre) == t.end()) continue;
        const std::string curve = "triangle " + std::to_string(constraints.size());
        constraints.push_back(lock(curve, keep));
        region.runs.push_back({curve, {t[0], t[1], t[2], t[0]}});
    }
    return constraints;
}

using Indices = std::vector<std::size_t>;

const double no_bound = std::numeric_limits<double>::infinity();

}  // namespace

TEST_SUITE("core/constrain/closure") {
    TEST_CASE("nothing is said where nothing contradicts") {
        const Region region = test::dome(6, 0.6);
        CHECK_FALSE(found(region, {}).has_value());
        CHECK_FALSE(found(region, {lock("bottom"), lock("right"), lock("top"), lock("left")}));
    }

    TEST_CASE("two vertices pinned to one point, and no others") {
        const Region region = test::dome(6, 0.6);
        const auto loop = found(region, {lock("left"), pin(6, {5, 5}), pin(0, {5, 5})});
        REQUIRE(loop.has_value());
        CHECK(loop->constraints == Indices{1, 2});
        CHECK(loop->gap_mm == doctest::Approx(region.distance(0, 6)));
        CHECK_FALSE(found(region, {pin(0, {5, 5}), pin(6, {5, 5.001})}));
        CHECK_FALSE(found(region, {pin(0, {5, 5}), pin(0, {5, 5})}));
        CHECK_FALSE(found(region, {pin(0, {5, 6}), pin(6, {6, 5})}));
    }

    TEST_CASE("the locked triangles around a vertex leave the gap of their angles") {
        Region flat = pyramid(0.0), steep = pyramid(5.0);
        CHECK_FALSE(found(flat, locked_neighbourhood(flat, 4)));
        const auto loop = found(steep, locked_neighbourhood(steep, 4));
        REQUIRE(loop.has_value());
        CHECK(loop->constraints == Indices{0, 1, 2, 3, 4, 5, 6, 7});
        CHECK((loop->position - Vec3(10, 10, 5)).norm() < 1e-12);
        // Spokes to the middles of the sides and to the corners, by turns.
        const double side = std::sqrt(100.0 + 25.0), corner = std::sqrt(200.0 + 25.0);
        const double angle = 8.0 * std::acos((100.0 + 25.0) / (side * corner));
        const double missing = 2.0 * std::numbers::pi - angle;
        CHECK(loop->gap_mm == doctest::Approx(missing * (side + corner) / 2.0));
        const std::string degrees = std::to_string(missing * 180.0 / std::numbers::pi);
        CHECK(loop->why.find(degrees.substr(0, 4)) != std::string::npos);
    }

    TEST_CASE("a neighbourhood with one edge free, or locked in sum only, can close") {
        Region steep = pyramid(5.0);
        std::vector<Constraint> constraints = locked_neighbourhood(steep, 4);
        Region sums = pyramid(5.0);
        CHECK_FALSE(found(sums, locked_neighbourhood(sums, 4, Keep::total)));
        constraints.pop_back();  // its outer edge is locked by nobody else
        CHECK_FALSE(found(steep, constraints));
    }

    TEST_CASE("a straight side may be as long as the others together, and no longer") {
        const Region region = rectangle();
        const auto with_others = [&](double percent) {
            return found(region, {straight("bottom"), lock("bottom"), range("right", -99, percent),
                                  range("top", -99, percent), range("left", -99, percent)});
        };
        CHECK_FALSE(with_others(-37.5));  // 0.625 * 160 = 100
        const auto loop = with_others(-50.0);
        REQUIRE(loop.has_value());
        CHECK(loop->gap_mm == doctest::Approx(20.0));
        CHECK(loop->constraints == Indices{0, 1, 2, 3, 4});
        CHECK_FALSE(with_others(no_bound));
    }

    TEST_CASE("a side that may bend proves nothing") {
        const Region region = rectangle();
        const std::vector<Constraint> short_others{lock("bottom"), range("right", -99, -50),
                                                   range("top", -99, -50), range("left", -99, -50)};
        CHECK_FALSE(found(region, short_others));
    }

    TEST_CASE("a straight side that gave way is not found again, nor in another region") {
        Region a = rectangle(), b = a;
        a.name = "a";
        b.name = "b";
        std::vector<Constraint> constraints{{Lock{"bottom", Keep::edges, "b"}},
                                            range("right", -95, -90, "b"),
                                            range("top", -95, -90, "b"),
                                            range("left", -95, -90, "b"),
                                            straight("bottom", "b")};
        CHECK(found({&a, &b}, constraints).has_value());
        constraints.back() = straight("bottom", "a");
        CHECK_FALSE(found({&a, &b}, constraints).has_value());
        constraints.pop_back();
        CHECK_FALSE(found({&a, &b}, constraints).has_value());
    }

    TEST_CASE("an area may be that of a circle of the border's length, and no larger") {
        const Region region = rectangle();
        const auto with_area = [&](double percent) {
            return found(region, {lock("bottom"), lock("right"), lock("top", Keep::total),
                                  lock("left"), area(percent)});
        };
        const double circle = 260.0 * 260.0 / (4.0 * std::numbers::pi);
        const double most = 100.0 * (circle / 3000.0 - 1.0);
        CHECK_FALSE(with_area(most - 0.01));
        CHECK_FALSE(with_area(-90.0));
        const auto loop = with_area(80.0);
        REQUIRE(loop.has_value());
        CHECK(loop->constraints == Indices{0, 1, 2, 3, 4});
        CHECK(loop->gap_mm == doctest::Approx(std::sqrt(4.0 * std::numbers::pi * 5400.0) - 260.0));
        CHECK_FALSE(found(region, {lock("bottom"), lock("right"), lock("left"), area(900.0)}));
    }
}

}  // namespace lastflat
