#include "core/numerics/multifrontal_ldlt.h"

#include <doctest/doctest.h>

#include <cmath>

#include "core/error.h"
#include "core/numerics/nested_dissection.h"

namespace lastflat {
namespace {

struct Grid {
    VertexGraph graph;
    Points2 positions;
    std::vector<std::pair<Index, Index>> edges;
};

Grid grid(Index side) {
    Grid result;
    for (Index v = 0; v < side * side; ++v) {
        result.positions.emplace_back(v % side, v / side);
        if ((v + 1) % side != 0) result.edges.emplace_back(v, v + 1);
        if (v + side < side * side) result.edges.emplace_back(v, v + side);
    }
    result.graph = vertex_graph(side * side, result.edges);
    return result;
}

/// The grid's Laplacian plus a little, and below it rows that tie every tenth vertex to the next:
/// quasi-definite. Lower triangle.
SparseMatrix quasi_definite(const Grid& grid, Index ties) {
    const auto n = grid.graph.size();
    std::vector<Eigen::Triplet<double>> entries;
    for (Index v = 0; v < n; ++v) entries.emplace_back(v, v, 5.0 + std::sin(v));
    for (const auto& [a, b] : grid.edges) entries.emplace_back(b, a, -1.0 + 0.1 * std::cos(a));
    for (Index k = 0; k < ties; ++k) {
        entries.emplace_back(n + k, 10 * k, 1.0);
        entries.emplace_back(n + k, 10 * k + 1, -1.0);
        entries.emplace_back(n + k, n + k, -1e-9);
    }
    SparseMatrix matrix(n + ties, n + ties);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
}

std::vector<UnknownBlock> blocks_of(const Grid& grid, Index ties) {
    std::vector<UnknownBlock> blocks;
    for (auto& block : nested_dissection(grid.graph, grid.positions))
        blocks.push_back({block.parent, std::move(block.vertices)});
    const auto top = static_cast<Index>(blocks.size());
    for (auto& block : blocks) block.parent = block.parent < 0 ? top : block.parent;
    blocks.push_back({-1, {}});
    for (Index k = 0; k < ties; ++k) blocks.back().unknowns.push_back(grid.graph.size() + k);
    return blocks;
}

}  // namespace

TEST_SUITE("core/numerics/nested_dissection") {
    TEST_CASE("every vertex is in one block, and blocks of different branches share no edge") {
        const Grid g = grid(23);
        const auto blocks = nested_dissection(g.graph, g.positions);
        std::vector<Index> block_of(static_cast<std::size_t>(g.graph.size()), -1);
        for (std::size_t b = 0; b < blocks.size(); ++b) {
            CHECK((blocks[b].parent == -1 || blocks[b].parent > static_cast<Index>(b)));
            for (const Index v : blocks[b].vertices) {
                CHECK(block_of[static_cast<std::size_t>(v)] == -1);
                block_of[static_cast<std::size_t>(v)] = static_cast<Index>(b);
            }
        }
        for (const auto& [v, w] : g.edges) {
            Index a = std::min(block_of[static_cast<std::size_t>(v)],
                               block_of[static_cast<std::size_t>(w)]);
            const Index b = std::max(block_of[static_cast<std::size_t>(v)],
                                     block_of[static_cast<std::size_t>(w)]);
            REQUIRE(a >= 0);
            while (a >= 0 && a < b) a = blocks[static_cast<std::size_t>(a)].parent;
            CHECK(a == b);
        }
    }

    TEST_CASE("a grid's separators are its lines") {
        const Grid g = grid(32);
        CHECK(nested_dissection(g.graph, g.positions).back().vertices.size() == 32);
    }

    TEST_CASE("a strip that is wound up is split across, wherever its vertices lie") {
        constexpr Index length = 2000;
        std::vector<std::pair<Index, Index>> edges;
        Points2 positions;
        for (Index v = 0; v < 2 * length; ++v) {
            positions.emplace_back(std::cos(v % 2 + 0.05 * v), std::sin(v % 2 + 0.05 * v));
            for (const Index next : {v + 1, v + 2}) {
                if (next < 2 * length) edges.emplace_back(v, next);
            }
        }
        for (const auto& block : nested_dissection(vertex_graph(2 * length, edges), positions))
            CHECK(block.vertices.size() < 64);
    }
}

TEST_SUITE("core/numerics/multifrontal_ldlt") {
    TEST_CASE("solves quasi-definite systems and counts their negative pivots") {
        for (const Index side : {1, 2, 7, 20, 61}) {
            const Grid g = grid(side);
            const Index ties = side * side / 12;
            const SparseMatrix A = quasi_definite(g, ties);
            MultifrontalLdlt solver;
            solver.analyse(A, blocks_of(g, ties));
            REQUIRE(solver.factor(A, Progress()));
            CHECK(solver.negative_pivots() == ties);
            const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(A.rows(), -1.0, 2.0);
            const Eigen::VectorXd x = solver.solve(b);
            CHECK((A.selfadjointView<Eigen::Lower>() * x - b).norm() < 1e-9 * b.norm());
        }
    }

    TEST_CASE("any number of threads gives the same bits") {
        const Grid g = grid(150);
        const SparseMatrix A = quasi_definite(g, 100);
        const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(A.rows(), -1.0, 2.0);
        MultifrontalLdlt solver;
        solver.analyse(A, blocks_of(g, 100));
        REQUIRE(solver.factor(A, Progress(), 1));
        const Eigen::VectorXd one = solver.solve(b);
        for (const std::size_t threads : {2u, 5u}) {
            REQUIRE(solver.factor(A, Progress(), threads));
            CHECK((solver.solve(b, threads).array() == one.array()).all());
        }
    }

    TEST_CASE("an indefinite matrix shows its negative eigenvalues, a singular one fails") {
        SparseMatrix A(2, 2);
        A.insert(0, 0) = 1.0;
        A.insert(1, 0) = 2.0;
        A.insert(1, 1) = 1.0;
        A.makeCompressed();
        MultifrontalLdlt solver;
        solver.analyse(A, {{-1, {0, 1}}});
        REQUIRE(solver.factor(A, Progress()));
        CHECK(solver.negative_pivots() == 1);
        A.coeffRef(1, 1) = 4.0;
        CHECK_FALSE(solver.factor(A, Progress()));
    }

    TEST_CASE("a canceled factorization stops") {
        const Grid g = grid(5);
        const SparseMatrix A = quasi_definite(g, 0);
        MultifrontalLdlt solver;
        solver.analyse(A, blocks_of(g, 0));
        Progress progress;
        progress.cancel();
        CHECK_THROWS_AS((void)solver.factor(A, progress), Error);
    }
}

}  // namespace lastflat
