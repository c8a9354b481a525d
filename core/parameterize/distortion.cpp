// Based on: Smith, de Goes, Kim, "Analytic Eigensystems for Isotropic Distortion Energies", TOG
// 2019; Smith, Schaefer, "Bijective Parameterization with Free Boundaries", SIGGRAPH 2015.
#include "core/parameterize/distortion.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numerics/singular_values.h"

namespace lastflat {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// The triangle's edges from its first vertex, in its own plane, first edge along x.
Eigen::Matrix2d rest_edges(const Region& region, const Triangle& t) {
    const Vec3 a = region.position(t[1]) - region.position(t[0]);
    const Vec3 b = region.position(t[2]) - region.position(t[0]);
    const double length = a.norm();
    Eigen::Matrix2d edges;
    edges << length, a.dot(b) / length, 0.0, a.cross(b).norm() / length;
    return edges;
}

Vec2 point(const Eigen::VectorXd& x, Index vertex) {
    return x.segment<2>(2 * vertex);
}

double smallest_positive_root(double a, double b, double c) {
    // a t^2 + b t + c = 0 with c > 0, by the formula that does not cancel.
    if (std::abs(a) < 1e-14 * std::abs(b)) return b < 0.0 ? -c / b : infinity;
    const double discriminant = b * b - 4.0 * a * c;
    if (discriminant < 0.0) return infinity;
    const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
    double least = infinity;
    for (const double root : {q / a, q != 0.0 ? c / q : infinity}) {
        if (root > 0.0) least = std::min(least, root);
    }
    return least;
}

/// d vec(F) / d x: F = [x1 - x0, x2 - x0] B, vec by columns.
Eigen::Matrix<double, 4, 6> chain(const Eigen::Matrix2d& B) {
    Eigen::Matrix<double, 4, 6> G = Eigen::Matrix<double, 4, 6>::Zero();
    for (Eigen::Index column = 0; column < 2; ++column) {
        for (Eigen::Index i = 0; i < 2; ++i) {
            G(2 * column + i, 0 + i) = -B(0, column) - B(1, column);
            G(2 * column + i, 2 + i) = B(0, column);
            G(2 * column + i, 4 + i) = B(1, column);
        }
    }
    return G;
}

/// A direction in the space of maps, U M V^T, as a vector.
Eigen::Vector4d direction(const Svd2& svd, const Eigen::Matrix2d& M) {
    const Eigen::Matrix2d D = svd.u * M * svd.v.transpose();
    return Eigen::Map<const Eigen::Vector4d>(D.data());
}

struct ElementDerivatives {
    Vector6 gradient;
    Matrix6 hessian;
};

ElementDerivatives element_derivatives(const Eigen::Matrix2d& F, const Eigen::Matrix2d& B,
                                       const IsotropicEnergy& energy, HessianKind kind) {
    const Svd2 svd = svd2(F);
    EnergyDerivatives e = energy.derivatives(svd.sigma[0], svd.sigma[1]);
    Eigen::Matrix2d stretch;
    stretch << e.d11, e.d12, e.d12, e.d22;
    if (kind == HessianKind::projected) {
        e.twist = std::max(e.twist, 0.0);
        e.flip = std::max(e.flip, 0.0);
        if (e.d11 * e.d22 < e.d12 * e.d12 || e.d11 + e.d22 < 0.0) {
            Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen;
            eigen.computeDirect(stretch);
            stretch = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() *
                      eigen.eigenvectors().transpose();
        }
    }
    const double h = std::sqrt(0.5);
    Eigen::Matrix<double, 4, 4> Q;
    Q.col(0) = direction(svd, Eigen::Vector2d(1, 0).asDiagonal());
    Q.col(1) = direction(svd, Eigen::Vector2d(0, 1).asDiagonal());
    Q.col(2) = direction(svd, (Eigen::Matrix2d() << 0, -h, h, 0).finished());
    Q.col(3) = direction(svd, (Eigen::Matrix2d() << 0, h, h, 0).finished());
    const Eigen::Matrix<double, 4, 6> P = Q.transpose() * chain(B);
    ElementDerivatives result;
    result.gradient = e.d1 * P.row(0).transpose() + e.d2 * P.row(1).transpose();
    result.hessian = P.topRows<2>().transpose() * stretch * P.topRows<2>() +
                     e.twist * P.row(2).transpose() * P.row(2) +
                     e.flip * P.row(3).transpose() * P.row(3);
    return result;
}

Index slot_of(const SparseMatrix& matrix, Index row, Index column) {
    const auto* begin = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column];
    const auto* end = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column + 1];
    return static_cast<Index>(std::lower_bound(begin, end, row) - matrix.innerIndexPtr());
}

}  // namespace

Distortion::Distortion(const Region& region, const IsotropicEnergy& energy) : energy_(energy) {
    elements_.reserve(region.triangles.size());
    for (const Triangle& t : region.triangles) {
        const Eigen::Matrix2d edges = rest_edges(region, t);
        elements_.push_back({t, edges.inverse(), 0.5 * edges.determinant()});
        total_area_ += elements_.back().area;
    }
}

Eigen::Matrix2d Distortion::gradient_of(const Element& element, const Eigen::VectorXd& x) {
    const auto& t = element.vertices;
    Eigen::Matrix2d edges;
    edges.col(0) = point(x, t[1]) - point(x, t[0]);
    edges.col(1) = point(x, t[2]) - point(x, t[0]);
    return edges * element.rest_inverse;
}

double Distortion::value(const Eigen::VectorXd& x) const {
    double sum = 0.0;
    for (const Element& element : elements_) {
        const Eigen::Matrix2d F = gradient_of(element, x);
        const double e = std::hypot(F(0, 0) + F(1, 1), F(1, 0) - F(0, 1));
        const double r = std::hypot(F(0, 0) - F(1, 1), F(1, 0) + F(0, 1));
        if (!(e > r)) return infinity;
        sum += element.area * energy_.value(0.5 * (e + r), 0.5 * (e - r));
    }
    return sum;
}

double Distortion::collapse_step(const Eigen::VectorXd& x, const Eigen::VectorXd& d) const {
    double least = infinity;
    const auto cross = [](const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); };
    for (const Element& element : elements_) {
        const auto& t = element.vertices;
        const Vec2 p1 = point(x, t[1]) - point(x, t[0]), p2 = point(x, t[2]) - point(x, t[0]);
        const Vec2 d1 = point(d, t[1]) - point(d, t[0]), d2 = point(d, t[2]) - point(d, t[0]);
        least = std::min(least, smallest_positive_root(cross(d1, d2), cross(d1, p2) + cross(p1, d2),
                                                       cross(p1, p2)));
    }
    return least;
}

void Distortion::bind(const SparseMatrix& matrix) {
    slots_.resize(elements_.size());
    for (std::size_t e = 0; e < elements_.size(); ++e) {
        std::size_t slot = 0;
        for (Index i = 0; i < 6; ++i) {
            for (Index j = 0; j <= i; ++j) {
                const Index a = 2 * elements_[e].vertices[static_cast<std::size_t>(i / 2)] + i % 2;
                const Index b = 2 * elements_[e].vertices[static_cast<std::size_t>(j / 2)] + j % 2;
                slots_[e][slot++] = slot_of(matrix, std::max(a, b), std::min(a, b));
            }
        }
    }
}

Eigen::VectorXd Distortion::differentiate(const Eigen::VectorXd& x, HessianKind kind,
                                          SparseMatrix& matrix) const {
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(x.size());
    double* values = matrix.valuePtr();
    for (std::size_t e = 0; e < elements_.size(); ++e) {
        const Element& element = elements_[e];
        const auto d =
            element_derivatives(gradient_of(element, x), element.rest_inverse, energy_, kind);
        for (Eigen::Index i = 0; i < 3; ++i) {
            gradient.segment<2>(2 * element.vertices[static_cast<std::size_t>(i)]) +=
                element.area * d.gradient.segment<2>(2 * i);
        }
        std::size_t slot = 0;
        for (Eigen::Index i = 0; i < 6; ++i) {
            for (Eigen::Index j = 0; j <= i; ++j) {
                values[slots_[e][slot++]] += element.area * d.hessian(i, j);
            }
        }
    }
    return gradient;
}

}  // namespace lastflat
