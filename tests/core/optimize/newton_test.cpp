#include "core/optimize/newton.h"

#include <doctest/doctest.h>

#include "tests/helpers/shapes.h"

namespace lastflat {
namespace {

/// A wavy square seen from above: no triangle is flipped.
Eigen::VectorXd seen_from_above(const Region& region) {
    Eigen::VectorXd x(2 * static_cast<Eigen::Index>(region.positions.size()));
    for (std::size_t v = 0; v < region.positions.size(); ++v)
        x.segment<2>(2 * static_cast<Eigen::Index>(v)) = region.positions[v].head<2>();
    return x;
}

/// The edges of a path keep their length.
std::vector<Row> kept(const Region& region, const std::vector<Index>& path) {
    std::vector<Row> rows;
    for (std::size_t i = 1; i < path.size(); ++i) {
        const Index a = path[i - 1], b = path[i];
        const double length = region.distance(a, b);
        rows.push_back({{{1.0, Length{a, b}}}, length, length, length, a});
    }
    return rows;
}

struct Square {
    Region region = test::saddle(8);
    Domain domain{{&region}};
    SymmetricDirichlet energy;
    Distortion distortion{domain, energy};
    Problem problem{domain, distortion, {}, kept(region, region.runs.front().vertices)};
};

}  // namespace

TEST_SUITE("core/optimize/newton") {
    TEST_CASE("rows that are kept cost energy, and are kept") {
        Square square;
        OptimalitySystem system, free_system;
        const Iterate start = Iterate::at(seen_from_above(square.region), square.problem);
        const Minimum minimum = minimise(square.problem, start, {}, system, Progress());
        CHECK(minimum.converged);
        CHECK(minimum.worst_error < 1e-10);
        const Problem free{square.domain, square.distortion};
        CHECK(minimise(free, {start.x, {}}, {}, free_system, Progress()).energy < minimum.energy);
    }

    TEST_CASE("a search goes on from the optimum and the multipliers that were kept") {
        Square square;
        OptimalitySystem system;
        const Minimum first =
            minimise(square.problem, Iterate::at(seen_from_above(square.region), square.problem),
                     {}, system, Progress());
        REQUIRE(first.iterations > 2);
        const Eigen::VectorXd x = square.domain.coordinates(first.charts);
        const Minimum again =
            minimise(square.problem, {x, first.multipliers}, {}, system, Progress());
        CHECK(again.converged);
        CHECK(again.iterations == 0);
        CHECK(again.charts[0].uv == first.charts[0].uv);
        for (Row& row : square.problem.rows) row.least = row.most *= 1.001;  // all a little longer
        const Minimum longer =
            minimise(square.problem, {x, first.multipliers}, {}, system, Progress());
        CHECK(longer.converged);
        CHECK(longer.iterations <= first.iterations);
        OptimalitySystem fresh;
        const Minimum anew =
            minimise(square.problem, Iterate::at(x, square.problem), {}, fresh, Progress());
        CHECK(test::rigid_difference(longer.charts[0].uv, anew.charts[0].uv) < 1e-7);
    }

    TEST_CASE("an approach ends as soon as it is near enough") {
        Square square;
        OptimalitySystem system;
        Eigen::VectorXd far = 3.0 * seen_from_above(square.region);
        const Minimum near = minimise(square.problem, Iterate::at(far, square.problem),
                                      {near_isometry, 0.0}, system, Progress());
        CHECK(near.converged);
        CHECK(near.energy < near_isometry);
        CHECK(near.projected_gradient > 1e-6);
    }

    TEST_CASE("a bound is held only while it pulls") {
        Square square;
        std::vector<Row>& rows = square.problem.rows;
        rows.erase(rows.begin() + 1, rows.end());
        rows[0].least *= 0.5;
        rows[0].most *= 2.0;
        OptimalitySystem system, bound_system;
        const Iterate start = Iterate::at(seen_from_above(square.region), square.problem);
        const Minimum wide = minimise(square.problem, start, {}, system, Progress());
        CHECK(wide.multipliers[0] == 0.0);
        const double reached = rows[0].value(square.domain.coordinates(wide.charts));
        rows[0].most = 0.99 * reached;
        const Minimum tight = minimise(square.problem, start, {}, bound_system, Progress());
        CHECK(tight.converged);
        CHECK(tight.multipliers[0] > 0.0);
        CHECK(rows[0].value(square.domain.coordinates(tight.charts)) ==
              doctest::Approx(0.99 * reached).epsilon(1e-9));
    }
}

}  // namespace lastflat
