#include "core/optimize/row.h"

#include <doctest/doctest.h>

#include "tests/helpers/derivatives.h"

namespace lastflat {
namespace {

/// Five points, the row's own at 2.
Eigen::VectorXd some_points() {
    Eigen::VectorXd x(10);
    x << 0.3, -1.2, 2.5, 0.4, 1.1, 1.7, -0.6, 2.9, 3.3, -2.0;
    return x;
}

Eigen::MatrixXd hessian_of(const Row& row, const Eigen::VectorXd& x, double multiplier,
                           HessianKind kind) {
    Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(x.size(), x.size());
    row.for_hessian(x, multiplier, kind, [&](Index a, Index b, const Eigen::Matrix2d& block) {
        hessian.block<2, 2>(2 * a, 2 * b) += block;
        if (a != b) hessian.block<2, 2>(2 * b, 2 * a) += block.transpose();
    });
    return hessian;
}

Row row(std::vector<RowTerm> terms) {
    return {std::move(terms), 0.0, 0.0, 1.0, 2};
}

/// A polygon's area does not depend on the origin, which moves with the row's own point.
Row area_row() {
    return row({{0.5, Cross{2, 4}}, {0.5, Cross{4, 3}}, {0.5, Cross{3, 0}}, {0.5, Cross{0, 2}}});
}

}  // namespace

TEST_SUITE("core/optimize/row") {
    TEST_CASE("gradient and Hessian of every kind are the derivatives of the value") {
        for (const Row& r :
             {row({{1.0, Length{0, 1}}}), row({{2.0, Length{2, 3}}, {-1.0, Length{3, 4}}}),
              area_row(), row({{1.0, Coordinate{2, 0}}}), row({{3.0, Coordinate{4, 1}}}),
              row({{1.5, Length{2, 4}}, {1.0, Coordinate{4, 0}}})}) {
            for (const double multiplier : {1.7, -0.4}) {
                const auto gradient = [&](const Eigen::VectorXd& x) {
                    Eigen::VectorXd sum = Eigen::VectorXd::Zero(x.size());
                    add_forces({r}, x, Eigen::VectorXd::Constant(1, multiplier), sum);
                    return sum;
                };
                const Eigen::VectorXd x = some_points();
                test::check_derivatives(
                    x, [&](const Eigen::VectorXd& at) { return multiplier * r.value(at); },
                    gradient, hessian_of(r, x, multiplier, HessianKind::exact), 1e-5, 1e-8);
            }
        }
    }

    TEST_CASE("a projected Hessian has no negative eigenvalue") {
        const Eigen::VectorXd x = some_points();
        for (const Row& r : {row({{1.0, Length{0, 1}}}), row({{-2.0, Length{2, 3}}}), area_row()}) {
            for (const double multiplier : {1.0, -1.0}) {
                const Eigen::VectorXd values = hessian_of(r, x, multiplier, HessianKind::projected)
                                                   .selfadjointView<Eigen::Lower>()
                                                   .eigenvalues();
                CHECK(values.minCoeff() > -1e-12);
            }
        }
    }

    TEST_CASE("what is missing has the sign of the bound that is broken") {
        Row bounds = row({{1.0, Length{0, 1}}});
        bounds.least = 2.0;
        bounds.most = 5.0;
        bounds.reference = 4.0;
        CHECK(bounds.violation(1.0) == -1.0);
        CHECK(bounds.violation(3.0) == 0.0);
        CHECK(bounds.violation(7.0) == 2.0);
        CHECK(bounds.relative_error(1.0) == 0.25);
        CHECK(area_row().vertices() == std::vector<Index>{0, 2, 3, 4});
    }
}

}  // namespace lastflat
