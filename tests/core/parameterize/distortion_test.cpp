#include "core/parameterize/distortion.h"

#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>

#include "core/measure/report.h"
#include "tests/helpers/shapes.h"

namespace lastflat {
namespace {

/// A chart away from any symmetry and minimum.
Eigen::VectorXd some_chart(const Region& region) {
    Eigen::VectorXd x(2 * static_cast<Eigen::Index>(region.positions.size()));
    for (std::size_t i = 0; i < region.positions.size(); ++i) {
        const Vec3& p = region.positions[i];
        x.segment<2>(2 * static_cast<Eigen::Index>(i)) =
            Vec2(1.2 * p.x() + 0.1 * p.y() + std::sin(0.05 * p.y()),
                 0.8 * p.y() + 0.002 * p.x() * p.x());
    }
    return x;
}

/// A matrix with a 2x2 block for every pair of vertices, lower triangle.
SparseMatrix dense_pattern(Eigen::Index n) {
    SparseMatrix matrix(n, n);
    for (Eigen::Index j = 0; j < n; ++j) {
        for (Eigen::Index i = j; i < n; ++i) matrix.insert(i, j) = 0.0;
    }
    matrix.makeCompressed();
    return matrix;
}

}  // namespace

TEST_SUITE("core/parameterize/distortion") {
    TEST_CASE("gradient and exact Hessian are the derivatives of the value") {
        const Region region = test::saddle(3);
        const SymmetricDirichlet energy;
        const Domain domain({&region});
        Distortion distortion(domain, energy);
        const Eigen::VectorXd x = some_chart(region);
        SparseMatrix H = dense_pattern(x.size());
        distortion.bind(H);
        distortion.add_hessian(x, HessianKind::exact, H);
        const Eigen::VectorXd gradient = distortion.gradient(x);
        const double h = 1e-5;
        for (Eigen::Index i = 0; i < x.size(); ++i) {
            Eigen::VectorXd a = x, b = x;
            a[i] -= h;
            b[i] += h;
            CHECK((distortion.value(b) - distortion.value(a)) / (2 * h) ==
                  doctest::Approx(gradient[i]).epsilon(1e-6));
            const Eigen::VectorXd difference =
                (distortion.gradient(b) - distortion.gradient(a)) / (2 * h);
            for (Eigen::Index j = 0; j < x.size(); ++j) {
                CHECK(std::abs(difference[j] - H.coeff(std::max(i, j), std::min(i, j))) < 1e-5);
            }
        }
    }

    TEST_CASE("the projected Hessian has no negative eigenvalue") {
        const Region region = test::saddle(3);
        const SymmetricDirichlet energy;
        const Domain domain({&region});
        Distortion distortion(domain, energy);
        Eigen::VectorXd x = 0.4 * some_chart(region);  // compressed: the exact one is indefinite
        SparseMatrix exact = dense_pattern(x.size()), projected = exact;
        distortion.bind(exact);
        distortion.add_hessian(x, HessianKind::exact, exact);
        distortion.add_hessian(x, HessianKind::projected, projected);
        const auto least = [](const SparseMatrix& m) {
            const Eigen::MatrixXd full = Eigen::MatrixXd(m).selfadjointView<Eigen::Lower>();
            return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(full).eigenvalues()[0];
        };
        CHECK(least(exact) < -0.1);
        CHECK(least(projected) > -1e-9);
    }

    TEST_CASE("the value agrees with the report, which is written from other formulas") {
        const Region region = test::saddle(6);
        const SymmetricDirichlet energy;
        const Domain domain({&region});
        const Distortion distortion(domain, energy);
        const Eigen::VectorXd x = some_chart(region);
        Points2 uv;
        for (Eigen::Index i = 0; i < x.size(); i += 2) uv.push_back(x.segment<2>(i));
        CHECK(distortion.value(x) / distortion.total_area() ==
              doctest::Approx(measure_distortion(region, uv).symmetric_dirichlet).epsilon(1e-12));
    }

    TEST_CASE("the collapse step is where the first triangle loses its area") {
        const Region region = test::plane(3);
        const SymmetricDirichlet energy;
        const Domain domain({&region});
        const Distortion distortion(domain, energy);
        const Eigen::VectorXd x = some_chart(region);
        Eigen::VectorXd d = Eigen::VectorXd::Zero(x.size());
        d[2 * 5] = 100.0;  // one inner vertex runs through its ring
        const double t = distortion.collapse_step(x, d);
        CHECK(std::isfinite(distortion.value(x + 0.999 * t * d)));
        CHECK(std::isinf(distortion.value(x + 1.001 * t * d)));
        CHECK(std::isinf(distortion.collapse_step(x, Eigen::VectorXd::Ones(x.size()))));
    }
}

}  // namespace lastflat
