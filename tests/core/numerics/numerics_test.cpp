#include <doctest/doctest.h>

#include <Eigen/LU>
#include <cmath>

#include "core/error.h"
#include "core/numerics/dominant_lu.h"
#include "core/numerics/elimination_order.h"
#include "core/numerics/polygon.h"
#include "core/numerics/singular_values.h"
#include "core/numerics/spd_cholesky.h"

namespace lastflat {

TEST_SUITE("core/numerics/singular_values") {
    TEST_CASE("rotation and reflection multiply to the matrix, the stretches to its determinant") {
        for (int k = 0; k < 60; ++k) {
            Eigen::Matrix2d F;
            F << std::sin(1.0 * k), std::cos(2.3 * k), std::sin(3.1 * k + 1), std::cos(0.7 * k);
            const StretchFrame frame = stretch_frame(F);
            Eigen::Matrix2d A, B;
            A << frame.rotation.x(), -frame.rotation.y(), frame.rotation.y(), frame.rotation.x();
            B << frame.reflection.x(), frame.reflection.y(), frame.reflection.y(),
                -frame.reflection.x();
            CHECK((frame.q * A + frame.r * B - F).norm() < 1e-14);
            CHECK(frame.rotation.norm() == doctest::Approx(1.0));
            CHECK(frame.reflection.norm() == doctest::Approx(1.0));
            CHECK(frame.larger() >= std::abs(frame.smaller()));
            CHECK(frame.larger() * frame.smaller() == doctest::Approx(F.determinant()));
        }
    }
}

TEST_SUITE("core/numerics/dominant_lu") {
    TEST_CASE("solves an unsymmetric M-matrix on a grid to round-off") {
        const int n = 15;
        std::vector<Eigen::Triplet<double>> entries;
        const auto id = [n](int i, int j) { return i * n + j; };
        for (int i = 0; i < n; ++i) {
            for (int j = 0; j < n; ++j) {
                double sum = i == 0 ? 0.5 : 0.0;  // held along one side only
                for (const auto& [a, b] : {std::pair(i - 1, j), std::pair(i + 1, j),
                                           std::pair(i, j - 1), std::pair(i, j + 1)}) {
                    if (a < 0 || b < 0 || a >= n || b >= n) continue;
                    const double w = 1.0 + 0.9 * std::sin(3.0 * id(i, j) + 5.0 * id(a, b));
                    entries.emplace_back(id(i, j), id(a, b), -w);
                    sum += w;
                }
                entries.emplace_back(id(i, j), id(i, j), sum);
            }
        }
        SparseMatrix A(n * n, n * n);
        A.setFromTriplets(entries.begin(), entries.end());
        const Eigen::MatrixXd x =
            Eigen::MatrixXd::NullaryExpr(n * n, 2, [](Eigen::Index i, Eigen::Index j) {
                return std::cos(static_cast<double>(i + 7 * j));
            });
        CHECK((DominantLu(A).solve(A * x) - x).norm() < 1e-10);
        CHECK((A - SparseMatrix(A.transpose())).norm() > 1.0);
    }

    TEST_CASE("a singular matrix is an error") {
        SparseMatrix A(2, 2);
        A.insert(0, 0) = 1;
        A.insert(0, 1) = -1;
        A.insert(1, 0) = -1;
        A.insert(1, 1) = 1;
        CHECK_THROWS_AS(DominantLu{A}, Error);
    }
}

TEST_SUITE("core/numerics/spd_cholesky") {
    TEST_CASE("a matrix that is not positive definite is an error") {
        SparseMatrix A(2, 2);
        A.insert(0, 0) = 1;
        A.insert(0, 1) = 2;
        A.insert(1, 1) = 1;
        CHECK_THROWS_AS((void)SpdCholesky(A), Error);
    }
}

TEST_SUITE("core/numerics/polygon") {
    TEST_CASE("the hull of points with collinear ones keeps strict corners only") {
        const Points2 points{{0, 0}, {1, 0}, {2, 0}, {2, 2}, {1, 1}, {0, 2}, {0, 1}};
        CHECK(convex_hull(points) == std::vector<Index>{0, 2, 3, 5});
    }

    TEST_CASE("crossings are found, neighbours are none") {
        CHECK(self_crossings({{0, 0}, {4, 0}, {4, 4}, {0, 4}}).empty());
        const auto bow = self_crossings({{0, 0}, {4, 4}, {4, 0}, {0, 4}});
        REQUIRE(bow.size() == 1);
        CHECK(bow[0].a == 0);
        CHECK(bow[0].b == 2);
    }

    TEST_CASE("a border that touches itself along a line counts as crossing") {
        CHECK_FALSE(self_crossings({{0, 0}, {6, 0}, {6, 3}, {4, 3}, {4, 0}, {2, 0}, {2, 3}, {0, 3}})
                        .empty());
    }

    TEST_CASE("the angle of a needle keeps its digits") {
        const double tiny = 1e-9;
        CHECK(angle_at(Vec2(0, 0), Vec2(1, 0), Vec2(1, tiny)) ==
              doctest::Approx(tiny).epsilon(1e-6));
    }

    TEST_CASE("a Cholesky factor solves its system, with and without a dense tail") {
        for (const int side : {3, 12, 40}) {  // grids; the largest has a tail
            const auto n = static_cast<Index>(side * side);
            std::vector<Eigen::Triplet<double>> entries;
            for (Index v = 0; v < n; ++v) {
                entries.emplace_back(v, v, 4.1 + 0.01 * (v % 7));
                for (const Index w : {v + 1, v + side}) {
                    if (w >= n || (w == v + 1 && w % side == 0)) continue;
                    entries.emplace_back(v, w, -1.0 - 0.02 * (v % 3));
                    entries.emplace_back(w, v, -1.0 - 0.02 * (v % 3));
                }
            }
            SparseMatrix pattern(n, n);
            pattern.setFromTriplets(entries.begin(), entries.end());
            const EliminationOrder order = elimination_order(pattern);
            std::vector<Index> place(order.size());
            for (std::size_t k = 0; k < order.size(); ++k)
                place[static_cast<std::size_t>(order[k])] = static_cast<Index>(k);
            for (auto& e : entries) {
                e = {place[static_cast<std::size_t>(e.row())],
                     place[static_cast<std::size_t>(e.col())], e.value()};
            }
            SparseMatrix A(n, n);
            A.setFromTriplets(entries.begin(), entries.end());
            const SparseMatrix upper = A.triangularView<Eigen::Upper>();
            const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(n, -1.0, 2.0);
            const Eigen::VectorXd x = SpdCholesky(upper).solve(b);
            CHECK((A * x - b).norm() < 1e-12 * b.norm());
        }
    }

    TEST_CASE("a matrix that loses definiteness in its dense tail is refused") {
        const Index n = 80;
        SparseMatrix A = Eigen::MatrixXd::Ones(n, n).sparseView();  // of rank one
        CHECK_THROWS_AS((void)SpdCholesky(SparseMatrix(A.triangularView<Eigen::Upper>())), Error);
        A.coeffRef(n - 1, n - 1) = -1.0;
        for (Index i = 0; i + 1 < n; ++i) A.coeffRef(i, i) = 100.0;
        CHECK_THROWS_AS((void)SpdCholesky(SparseMatrix(A.triangularView<Eigen::Upper>())), Error);
    }
}

}  // namespace lastflat
