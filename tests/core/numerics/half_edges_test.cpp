#include "core/numerics/half_edges.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "tests/helpers/shapes.h"

namespace lastflat {
namespace {

HalfEdges half_edges_of(std::size_t vertices, const std::vector<Triangle>& triangles) {
    return HalfEdges({Points3(vertices, Vec3::Zero()), triangles});
}

/// Six triangles around vertex 6.
HalfEdges hexagon() {
    std::vector<Triangle> triangles;
    for (Index i = 0; i < 6; ++i) triangles.push_back({i, (i + 1) % 6, 6});
    return half_edges_of(7, triangles);
}

/// A strip of six triangles around a triangular hole: 0, 1, 2 outside, 3, 4, 5 inside.
HalfEdges annulus() {
    return half_edges_of(6, {{0, 1, 4}, {4, 3, 0}, {1, 2, 5}, {5, 4, 1}, {2, 0, 3}, {3, 5, 2}});
}

HalfEdges of_tetrahedron() {
    return half_edges_of(4, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
}

std::vector<Index> fan(const HalfEdges& half_edges, Index vertex) {
    std::vector<Index> ends;
    for (const Index h : half_edges.around(vertex)) ends.push_back(half_edges.to(h));
    return ends;
}

using Vertices = std::vector<Index>;

}  // namespace

TEST_SUITE("core/numerics/half_edges") {
    TEST_CASE("a half-edge runs from a corner to the next and bounds its triangle") {
        const HalfEdges half_edges = half_edges_of(5, {{2, 0, 1}, {0, 2, 4}});
        CHECK(half_edges.count() == 6);
        CHECK(half_edges.vertex_count() == 5);
        CHECK(half_edges.from(1) == 0);
        CHECK(half_edges.to(1) == 1);
        CHECK(half_edges.apex(1) == 2);
        CHECK(half_edges.to(2) == 2);
        CHECK(HalfEdges::next(5) == 3);
        CHECK(HalfEdges::previous(3) == 5);
        CHECK(half_edges.twin(0) == 3);
        CHECK(half_edges.twin(3) == 0);
        for (const Index h : {1, 2, 4, 5}) CHECK(half_edges.twin(h) == -1);
    }

    TEST_CASE("an isolated vertex has nothing around it") {
        const HalfEdges half_edges = half_edges_of(5, {{2, 0, 1}, {0, 2, 4}});
        CHECK(half_edges.outgoing(3) == -1);
        CHECK(!half_edges.on_border(3));
        CHECK(half_edges.ring(3).empty());
        CHECK(half_edges.find(3, 0) == -1);
    }

    TEST_CASE("the ring of an inner vertex is closed and begins at its smallest neighbour") {
        CHECK(hexagon().ring(6) == Vertices{0, 1, 2, 3, 4, 5});
        CHECK(of_tetrahedron().ring(3) == Vertices{0, 1, 2});
        CHECK(of_tetrahedron().ring(0) == Vertices{1, 3, 2});
        // The fan begins with the first triangle that names the vertex.
        CHECK(fan(of_tetrahedron(), 0) == Vertices{2, 1, 3});
    }

    TEST_CASE("the ring of a border vertex runs from its successor to its predecessor") {
        CHECK(hexagon().ring(2) == Vertices{3, 6, 1});
        CHECK(fan(hexagon(), 2) == Vertices{3, 6});
        CHECK(annulus().ring(0) == Vertices{1, 4, 3, 2});
        CHECK(annulus().ring(4) == Vertices{3, 0, 1, 5});
    }

    TEST_CASE("an edge is found by its ends, in its direction") {
        const HalfEdges half_edges = hexagon();
        CHECK(half_edges.find(6, 3) == 3 * 3 + 2);
        CHECK(half_edges.find(3, 6) == 3 * 2 + 1);
        CHECK(half_edges.find(2, 3) == 3 * 2);
        CHECK(half_edges.find(3, 2) == -1);  // beyond the border there is no triangle
        CHECK(half_edges.find(0, 3) == -1);
    }

    TEST_CASE("border loops keep the surface on their left and begin at their smallest vertex") {
        CHECK(hexagon().border_loops() == std::vector<Vertices>{{0, 1, 2, 3, 4, 5}});
        CHECK(annulus().border_loops() == std::vector<Vertices>{{0, 1, 2}, {3, 5, 4}});
        CHECK(of_tetrahedron().border_loops().empty());
        CHECK(half_edges_of(6, {{5, 3, 4}, {0, 1, 2}}).border_loops() ==
              std::vector<Vertices>{{0, 1, 2}, {3, 4, 5}});
    }

    TEST_CASE("every edge is found from both of its triangles, on any surface") {
        for (const Region& region : {test::dome(), test::saddle(), test::cone(), test::plane()}) {
            const HalfEdges half_edges(region);
            std::vector<std::size_t> degree(region.positions.size(), 0);
            for (Index h = 0; h < half_edges.count(); ++h) {
                const Triangle& t = region.triangles[at(h / 3)];
                CHECK(half_edges.from(h) == t[at(h % 3)]);
                CHECK(half_edges.find(half_edges.from(h), half_edges.to(h)) == h);
                CHECK(half_edges.find(half_edges.to(h), half_edges.from(h)) == half_edges.twin(h));
                ++degree[at(half_edges.from(h))];
            }
            for (Index v = 0; v < half_edges.vertex_count(); ++v) {
                const auto ring = half_edges.ring(v);
                const bool is_border =
                    std::find(region.border.begin(), region.border.end(), v) != region.border.end();
                CHECK(half_edges.on_border(v) == is_border);
                CHECK(ring.size() == degree[at(v)] + (is_border ? 1 : 0));
                for (std::size_t i = 0; i < degree[at(v)]; ++i)
                    CHECK(half_edges.apex(half_edges.find(v, ring[i])) ==
                          ring[(i + 1) % ring.size()]);
            }
        }
    }
}

}  // namespace lastflat
