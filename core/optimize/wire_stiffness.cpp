#include "core/optimize/wire_stiffness.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/numerics/polygon.h"

namespace lastflat {
namespace {

/// Of the surface's area to the power of 3/2. A half of a last: about 4 mm^3.
constexpr double stiffness_share = 1.5e-6;

/// The angle at b from the edge to c, counter-clockwise, to the edge to a; nothing if the surface
/// does not reach from one to the other.
std::optional<double> left_angle(const Region& region, Index a, Index b, Index c) {
    const HalfEdges& half_edges = region.half_edges;
    const Index first = half_edges.find(b, c);
    double sum = 0.0;
    for (Index h = first; h >= 0;) {
        const Index beside = half_edges.apex(h);
        sum += angle_at(region.position(b), region.position(half_edges.to(h)),
                        region.position(beside));
        if (beside == a) return sum;
        h = half_edges.rotated(h);
        if (h == first) break;
    }
    return std::nullopt;
}

/// How much the path a, b, c turns on the surface: what its two sides agree on, or its only one.
double turn_on_surface(const Region& region, Index a, Index b, Index c) {
    const auto left = left_angle(region, a, b, c), right = left_angle(region, c, b, a);
    if (left && right) return 0.5 * (*right - *left);
    if (left) return std::numbers::pi - *left;
    if (right) return *right - std::numbers::pi;
    return 0.0;
}

struct Turn {
    double value;
    Vector6 gradient;
};

Turn turn_of(const Triangle& vertices, const Eigen::VectorXd& x) {
    const Vec2 e = point(x, vertices[1]) - point(x, vertices[0]);
    const Vec2 f = point(x, vertices[2]) - point(x, vertices[1]);
    const Vec2 de = Vec2(-e.y(), e.x()) / e.squaredNorm();
    const Vec2 df = Vec2(-f.y(), f.x()) / f.squaredNorm();
    Turn turn{std::atan2(cross(e, f), e.dot(f)), {}};
    turn.gradient << de, -de - df, df;
    return turn;
}

/// The difference of two angles, in [-pi, pi].
double between(double a, double b) {
    return std::remainder(a - b, 2.0 * std::numbers::pi);
}

/// Second derivative of a vector's angle.
Eigen::Matrix2d angle_hessian(const Vec2& e) {
    const double mixed = e.y() * e.y() - e.x() * e.x(), twice = 2.0 * e.x() * e.y();
    Eigen::Matrix2d hessian;
    hessian << twice, mixed, mixed, -twice;
    return hessian / (e.squaredNorm() * e.squaredNorm());
}

}  // namespace

WireStiffness::WireStiffness(const Domain& domain, const std::vector<Wire>& wires) {
    for (const Wire& wire : wires) {
        const Region& region = *domain.regions[wire.region];
        const double k = stiffness_share * std::pow(surface_area(region), 1.5);
        const Index first = domain.first[wire.region];
        for (std::size_t i = 1; i + 1 < wire.vertices.size(); ++i) {
            const Index a = wire.vertices[i - 1], b = wire.vertices[i], c = wire.vertices[i + 1];
            const double length = 0.5 * (region.distance(a, b) + region.distance(b, c));
            bends_.push_back(
                {{a + first, b + first, c + first}, turn_on_surface(region, a, b, c), k / length});
        }
    }
}

std::vector<Triangle> WireStiffness::elements() const {
    std::vector<Triangle> ascending;
    for (const Bend& bend : bends_) {
        ascending.push_back(bend.vertices);
        std::sort(ascending.back().begin(), ascending.back().end());
    }
    return ascending;
}

void WireStiffness::for_hessian(const Eigen::VectorXd& x, HessianKind kind,
                                const TakeHessian& take) const {
    for (const Bend& bend : bends_)
        take_ascending(bend.vertices, bend_hessian(bend, x, kind), take);
}

double WireStiffness::value(const Eigen::VectorXd& x) const {
    double sum = 0.0;
    for (const Bend& bend : bends_) {
        const double excess = between(turn_of(bend.vertices, x).value, bend.turn);
        sum += 0.5 * bend.stiffness * excess * excess;
    }
    return sum;
}

void WireStiffness::add_gradient(const Eigen::VectorXd& x, Eigen::VectorXd& gradient) const {
    for (const Bend& bend : bends_) {
        const Turn turn = turn_of(bend.vertices, x);
        const double moment = bend.stiffness * between(turn.value, bend.turn);
        for (Eigen::Index i = 0; i < 3; ++i) {
            gradient.segment<2>(2 * bend.vertices[static_cast<std::size_t>(i)]) +=
                moment * turn.gradient.segment<2>(2 * i);
        }
    }
}

Matrix6 WireStiffness::bend_hessian(const Bend& bend, const Eigen::VectorXd& x, HessianKind kind) {
    const Turn turn = turn_of(bend.vertices, x);
    Matrix6 hessian = bend.stiffness * turn.gradient * turn.gradient.transpose();
    if (kind == HessianKind::projected) return hessian;
    const double moment = bend.stiffness * between(turn.value, bend.turn);
    const auto add = [&](const Vec2& edge, Eigen::Index from, double sign) {
        const Eigen::Matrix2d part = sign * moment * angle_hessian(edge);
        hessian.block<2, 2>(from, from) += part;
        hessian.block<2, 2>(from + 2, from + 2) += part;
        hessian.block<2, 2>(from, from + 2) -= part;
        hessian.block<2, 2>(from + 2, from) -= part;
    };
    add(point(x, bend.vertices[1]) - point(x, bend.vertices[0]), 0, -1.0);
    add(point(x, bend.vertices[2]) - point(x, bend.vertices[1]), 2, 1.0);
    return hessian;
}

}  // namespace lastflat
