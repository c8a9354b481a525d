// Whether derivatives are those of a value.
#pragma once

#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>

#include "core/optimize/energy_term.h"

namespace lastflat::test {

/// Of the lower triangles of elements, the whole sum.
inline Eigen::MatrixXd hessian_of(const EnergyTerm& term, const Eigen::VectorXd& x,
                                  HessianKind kind) {
    Eigen::MatrixXd lower = Eigen::MatrixXd::Zero(x.size(), x.size());
    term.for_hessian(x, kind, [&](const Triangle& element, const Matrix6& hessian) {
        for (Index i = 0; i < 6; ++i) {
            for (Index j = 0; j <= i; ++j) {
                const Index a = 2 * element[at(i / 2)] + i % 2, b = 2 * element[at(j / 2)] + j % 2;
                lower(std::max(a, b), std::min(a, b)) += hessian(i, j);
            }
        }
    });
    return lower.selfadjointView<Eigen::Lower>();
}

inline Eigen::VectorXd gradient_of(const EnergyTerm& term, const Eigen::VectorXd& x) {
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(x.size());
    term.add_gradient(x, gradient);
    return gradient;
}

/// Checks a gradient and a Hessian at x against central differences of width 2 h, to a share of
/// their norms.
template <class Value, class Gradient>
void check_derivatives(const Eigen::VectorXd& x, const Value& value, const Gradient& gradient,
                       const Eigen::MatrixXd& hessian, double h, double share) {
    const Eigen::VectorXd slope = gradient(x);
    REQUIRE(slope.norm() > 0.0);
    for (Eigen::Index i = 0; i < x.size(); ++i) {
        Eigen::VectorXd a = x, b = x;
        a[i] -= h;
        b[i] += h;
        CHECK(std::abs((value(b) - value(a)) / (2 * h) - slope[i]) <= share * slope.norm());
        const Eigen::VectorXd bend = (gradient(b) - gradient(a)) / (2 * h);
        CHECK((bend - hessian.col(i)).norm() <= share * std::max(hessian.norm(), slope.norm()));
    }
}

inline void check_derivatives(const EnergyTerm& term, const Eigen::VectorXd& x, double h,
                              double share) {
    check_derivatives(
        x, [&](const Eigen::VectorXd& at) { return term.value(at); },
        [&](const Eigen::VectorXd& at) { return gradient_of(term, at); },
        hessian_of(term, x, HessianKind::exact), h, share);
}

/// Checks that the elements always there come first and in their order, and that every projected
/// Hessian is one of descent.
inline void check_elements(const EnergyTerm& term, const Eigen::VectorXd& x) {
    const auto always = term.elements();
    std::vector<Triangle> seen;
    term.for_hessian(x, HessianKind::projected,
                     [&](const Triangle& element, const Matrix6& hessian) {
                         const Matrix6 whole = hessian.selfadjointView<Eigen::Lower>();
                         const Vector6 values = whole.selfadjointView<Eigen::Lower>().eigenvalues();
                         CHECK(values.minCoeff() >= -1e-9 * (1.0 + values.maxCoeff()));
                         seen.push_back(element);
                     });
    REQUIRE(seen.size() >= always.size());
    CHECK(std::equal(always.begin(), always.end(), seen.begin()));
}

}  // namespace lastflat::test
