#include "core/landmarks/min_cut.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

namespace lastflat {
namespace {

double cost(const std::vector<GraphEdge>& edges, const std::vector<bool>& inside) {
    double sum = 0.0;
    for (const GraphEdge& edge : edges)
        sum += inside[at(edge.a)] != inside[at(edge.b)] ? edge.weight : 0.0;
    return sum;
}

}  // namespace

TEST_SUITE("core/landmarks/min_cut") {
    TEST_CASE("of small graphs no other cut costs less") {
        std::mt19937 random(7);
        const auto draw = [&](int below) { return static_cast<Index>(random() % below); };
        for (int graph = 0; graph < 200; ++graph) {
            const int nodes = 4 + draw(7);
            std::vector<Side2> sides(at(nodes), Side2::free);
            sides[0] = Side2::first;
            sides[1] = Side2::second;
            if (graph % 3 == 0) sides[2] = Side2::first;
            if (graph % 5 == 0) sides[3] = Side2::second;
            std::vector<GraphEdge> edges;
            for (int e = 0; e < 3 * nodes; ++e)
                edges.push_back({draw(nodes), draw(nodes), 0.25 * (1 + draw(8))});
            const auto found = minimum_cut(edges, sides);
            double least = INFINITY;
            for (unsigned cut = 0; cut < 1U << nodes; ++cut) {
                std::vector<bool> inside;
                bool fits = true;
                for (int n = 0; n < nodes; ++n) {
                    inside.push_back((cut >> n & 1U) != 0);
                    fits = fits && sides[at(n)] != (inside.back() ? Side2::second : Side2::first);
                }
                if (fits) least = std::min(least, cost(edges, inside));
            }
            CHECK(cost(edges, found) == doctest::Approx(least));
            for (int n = 0; n < nodes; ++n)
                CHECK(sides[at(n)] != (found[at(n)] ? Side2::second : Side2::first));
        }
    }

    TEST_CASE("in a graph that is cut on a coarser one first, a cheap line is followed exactly") {
        constexpr Index n = 300;
        const auto node = [](Index row, Index column) { return row * n + column; };
        const auto is_left = [](Index row, Index column) {
            return column < 150 + std::lround(60.0 * std::sin(0.05 * row));
        };
        std::vector<Side2> sides(at(n * n), Side2::free);
        std::vector<GraphEdge> edges;
        std::vector<bool> expected;
        for (Index row = 0; row < n; ++row) {
            sides[at(node(row, 0))] = Side2::first;
            sides[at(node(row, n - 1))] = Side2::second;
            for (Index column = 0; column < n; ++column) {
                expected.push_back(is_left(row, column));
                for (const auto& [r, c] :
                     {std::pair(row + 1, column), std::pair(row, column + 1)}) {
                    if (r == n || c == n) continue;
                    const bool is_line = is_left(row, column) != is_left(r, c);
                    edges.push_back({node(row, column), node(r, c), is_line ? 0.01 : 1.0});
                }
            }
        }
        CHECK(minimum_cut(edges, sides) == expected);
    }

    TEST_CASE("a large graph that cannot be made coarser is cut as it is") {
        std::vector<Side2> sides{Side2::first, Side2::second};
        std::vector<GraphEdge> edges;
        for (Index n = 2; n < 30'000; ++n) {  // each free node has only given ones beside it
            sides.push_back(Side2::free);
            edges.push_back({0, n, n % 3 == 0 ? 2.0 : 1.0});
            edges.push_back({1, n, 1.5});
        }
        const auto inside = minimum_cut(edges, sides);
        for (Index n = 2; n < 30'000; ++n) CHECK(inside[at(n)] == (n % 3 == 0));
    }
}

}  // namespace lastflat
