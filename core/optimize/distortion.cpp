// Based on: Smith, de Goes, Kim, "Analytic Eigensystems for Isotropic Distortion Energies", TOG
// 2019; Smith, Schaefer, "Bijective Parameterization with Free Boundaries", SIGGRAPH 2015.
#include "core/optimize/distortion.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numerics/polygon.h"
#include "core/numerics/quadratic.h"
#include "core/numerics/singular_values.h"
#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

/// The triangle's edges from its first vertex, in its own plane, first edge along x.
Eigen::Matrix2d rest_edges(const Region& region, const Triangle& t) {
    const Vec3 a = region.position(t[1]) - region.position(t[0]);
    const Vec3 b = region.position(t[2]) - region.position(t[0]);
    const double length = a.norm();
    Eigen::Matrix2d edges;
    edges << length, a.dot(b) / length, 0.0, a.cross(b).norm() / length;
    return edges;
}

/// Of a t^2 + b t + c with c > 0.
double smallest_positive_root(double a, double b, double c) {
    if (std::abs(a) < tolerance::linear * std::abs(b)) return b < 0.0 ? -c / b : infinity;
    double least = infinity;
    for (const double root : quadratic_roots(a, b, c)) {
        if (root > 0.0) least = std::min(least, root);
    }
    return least;
}

Vec2 quarter_turn(const Vec2& v) {
    return {-v.y(), v.x()};
}

/// How much of a direction in the space of maps, given by its products with the two rows of the
/// inverse rest edges, every coordinate of the triangle moves: F = [x1 - x0, x2 - x0] B.
Vector6 along(const Vec2& first, const Vec2& second) {
    Vector6 result;
    result << -first - second, first, second;
    return result;
}

/// The stretches' derivatives along the four directions of a `StretchFrame`.
struct StretchDirections {
    Vector6 larger, smaller, twist, flip;
};

Vec2 rotated(const StretchFrame& frame, const Vec2& b) {
    return {frame.rotation.x() * b.x() - frame.rotation.y() * b.y(),
            frame.rotation.y() * b.x() + frame.rotation.x() * b.y()};
}

Vec2 reflected(const StretchFrame& frame, const Vec2& b) {
    return {frame.reflection.x() * b.x() + frame.reflection.y() * b.y(),
            frame.reflection.y() * b.x() - frame.reflection.x() * b.y()};
}

StretchDirections stretch_directions(const StretchFrame& frame, const Eigen::Matrix2d& B) {
    const Vec2 b1 = B.row(0), b2 = B.row(1);
    const Vec2 A1 = rotated(frame, b1), A2 = rotated(frame, b2);
    const Vec2 R1 = reflected(frame, b1), R2 = reflected(frame, b2);
    const double h = std::sqrt(0.5);
    return {along(0.5 * (A1 + R1), 0.5 * (A2 + R2)), along(0.5 * (A1 - R1), 0.5 * (A2 - R2)),
            along(h * quarter_turn(A1), h * quarter_turn(A2)),
            along(h * quarter_turn(R1), h * quarter_turn(R2))};
}

/// The nearest positive semi-definite one, in the norm of its eigenvalues.
void project(EnergyDerivatives& e) {
    e.twist = std::max(e.twist, 0.0);
    e.flip = std::max(e.flip, 0.0);
    if (e.d11 * e.d22 >= e.d12 * e.d12 && e.d11 + e.d22 >= 0.0) return;
    Eigen::Matrix2d stretch;
    stretch << e.d11, e.d12, e.d12, e.d22;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen;
    eigen.computeDirect(stretch);
    stretch = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() *
              eigen.eigenvectors().transpose();
    e.d11 = stretch(0, 0);
    e.d12 = stretch(0, 1);
    e.d22 = stretch(1, 1);
}

/// The lower triangle of it is meant.
Matrix6 element_hessian(const Eigen::Matrix2d& F, const Eigen::Matrix2d& B, double weight,
                        const IsotropicEnergy& energy, HessianKind kind) {
    const StretchFrame frame = stretch_frame(F);
    EnergyDerivatives e = energy.derivatives(frame.larger(), frame.smaller());
    if (kind == HessianKind::projected) project(e);
    const StretchDirections d = stretch_directions(frame, B);
    Matrix6 hessian;
    const Vector6 larger = weight * (e.d11 * d.larger + e.d12 * d.smaller);
    const Vector6 smaller = weight * (e.d12 * d.larger + e.d22 * d.smaller);
    const Vector6 twist = weight * e.twist * d.twist, flip = weight * e.flip * d.flip;
    for (Eigen::Index j = 0; j < 6; ++j) {
        hessian.col(j) =
            d.larger[j] * larger + d.smaller[j] * smaller + d.twist[j] * twist + d.flip[j] * flip;
    }
    return hessian;
}

}  // namespace

Distortion::Distortion(const Domain& domain, const IsotropicEnergy& energy,
                       const std::vector<std::vector<double>>& weights)
    : energy_(energy) {
    for (std::size_t r = 0; r < domain.regions.size(); ++r) {
        const Region& region = *domain.regions[r];
        elements_.reserve(elements_.size() + region.triangles.size());
        for (std::size_t i = 0; i < region.triangles.size(); ++i) {
            Triangle t = region.triangles[i];
            const double weight = weights.empty() ? 1.0 : weights[r][i];
            const Eigen::Matrix2d edges = rest_edges(region, t);
            for (Index& v : t) v += domain.first[r];
            elements_.push_back({t, edges.inverse(), weight * 0.5 * edges.determinant()});
            total_area_ += elements_.back().area;
        }
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
        const StretchFrame frame = stretch_frame(F);
        if (!(frame.smaller() > 0.0)) return infinity;
        sum += element.area * energy_.value(frame.larger(), frame.smaller());
    }
    return sum;
}

double Distortion::largest_step(const Eigen::VectorXd& x, const Eigen::VectorXd& d) const {
    double least = infinity;
    for (const Element& element : elements_) {
        const auto& t = element.vertices;
        const Vec2 p1 = point(x, t[1]) - point(x, t[0]), p2 = point(x, t[2]) - point(x, t[0]);
        const Vec2 d1 = point(d, t[1]) - point(d, t[0]), d2 = point(d, t[2]) - point(d, t[0]);
        least = std::min(least, smallest_positive_root(cross(d1, d2), cross(d1, p2) + cross(p1, d2),
                                                       cross(p1, p2)));
    }
    return std::min(1.0, 0.95 * least);
}

std::vector<Triangle> Distortion::elements() const {
    std::vector<Triangle> triangles;
    triangles.reserve(elements_.size());
    for (const Element& element : elements_) triangles.push_back(element.vertices);
    return triangles;
}

void Distortion::for_hessian(const Eigen::VectorXd& x, HessianKind kind,
                             const TakeHessian& take) const {
    for (const Element& element : elements_) {
        take(element.vertices, element_hessian(gradient_of(element, x), element.rest_inverse,
                                               element.area, energy_, kind));
    }
}

void Distortion::add_gradient(const Eigen::VectorXd& x, Eigen::VectorXd& gradient) const {
    for (const Element& element : elements_) {
        const StretchFrame frame = stretch_frame(gradient_of(element, x));
        const EnergyDerivatives e = energy_.derivatives(frame.larger(), frame.smaller());
        // Of the stretches along the two rows of B, see `stretch_directions`.
        const double turned = 0.5 * element.area * (e.d1 + e.d2);
        const double mirrored = 0.5 * element.area * (e.d1 - e.d2);
        const auto force = [&](const Vec2& b) {
            return Vec2(turned * rotated(frame, b) + mirrored * reflected(frame, b));
        };
        const Vec2 first = force(element.rest_inverse.row(0));
        const Vec2 second = force(element.rest_inverse.row(1));
        gradient.segment<2>(2 * element.vertices[0]) -= first + second;
        gradient.segment<2>(2 * element.vertices[1]) += first;
        gradient.segment<2>(2 * element.vertices[2]) += second;
    }
}

}  // namespace lastflat
