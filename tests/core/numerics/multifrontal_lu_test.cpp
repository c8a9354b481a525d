#include "core/numerics/multifrontal_lu.h"

#include <doctest/doctest.h>

#include <cmath>

#include "core/error.h"
#include "core/numerics/surface_elimination.h"
#include "tests/helpers/shapes.h"

namespace lastflat {
namespace {

/// A weakly dominant matrix over the surface's edges, held at the vertices that are not unknown,
/// its values unlike those of its transpose.
SparseMatrix mean_matrix(const Region& region, const Elimination& elimination) {
    const auto& vertices = elimination.vertices;
    const auto number = inverse(vertices, region.positions.size());
    std::vector<Eigen::Triplet<double>> entries;
    for (Index row = 0; row < static_cast<Index>(vertices.size()); ++row) {
        double sum = 0.0;
        for (const Index w : region.half_edges.ring(vertices[at(row)])) {
            const double weight = 1.0 + 0.9 * std::sin(3.0 * row + 5.0 * w);
            if (number[at(w)] >= 0) entries.emplace_back(row, number[at(w)], -weight);
            sum += weight;
        }
        entries.emplace_back(row, row, sum);
    }
    const auto n = static_cast<Index>(vertices.size());
    SparseMatrix matrix(n, n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
}

}  // namespace

TEST_SUITE("core/numerics/multifrontal_lu") {
    TEST_CASE("an unsymmetric system over a surface is solved to round-off") {
        for (const int side : {1, 4, 30, 90}) {  // from a single front to separators of many strips
            const Region region = test::grid(side, side, [](double s, double t) {
                return Vec3(100 * s, 80 * t, 9 * std::sin(7 * s + t));
            });
            const Elimination elimination = elimination_of(
                dissection_of(region.positions, region.half_edges), [](Index v) { return v > 1; });
            const SparseMatrix A = mean_matrix(region, elimination);
            const Eigen::MatrixXd x =
                Eigen::MatrixXd::NullaryExpr(A.rows(), 2, [](Eigen::Index i, Eigen::Index j) {
                    return std::cos(static_cast<double>(i + 7 * j));
                });
            const MultifrontalLu factor(A, elimination.blocks);
            CHECK((factor.solve(A * x) - x).norm() < 1e-10 * x.norm() * side);
            CHECK((A - SparseMatrix(A.transpose())).norm() > 1e-3);
        }
    }

    TEST_CASE("a singular matrix is an error") {
        SparseMatrix A(2, 2);
        A.insert(0, 0) = 1;
        A.insert(0, 1) = -1;
        A.insert(1, 0) = -1;
        A.insert(1, 1) = 1;
        A.makeCompressed();
        CHECK_THROWS_AS((MultifrontalLu{A, {{-1, {0, 1}}}}), Error);
        CHECK_THROWS_AS((MultifrontalLu{A, {{1, {0}}, {-1, {1}}}}), Error);
    }

    TEST_CASE("every unknown is in one block, after those of its children") {
        const Region region = test::dome();
        const auto is_unknown = [&](Index v) { return !region.half_edges.on_border(v); };
        const Elimination elimination =
            elimination_of(dissection_of(region.positions, region.half_edges), is_unknown);
        Index next = 0;
        for (std::size_t b = 0; b < elimination.blocks.size(); ++b) {
            const auto& [parent, unknowns] = elimination.blocks[b];
            CHECK((parent < 0 || at(parent) > b));
            CHECK_FALSE(unknowns.empty());
            for (const Index unknown : unknowns) CHECK(unknown == next++);
        }
        CHECK(at(next) == elimination.vertices.size());
        std::size_t inner = 0;
        for (Index v = 0; v < static_cast<Index>(region.positions.size()); ++v)
            inner += is_unknown(v) ? 1 : 0;
        CHECK(elimination.vertices.size() == inner);
    }
}

}  // namespace lastflat
