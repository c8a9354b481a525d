// Based on: Smith, Schaefer, "Bijective Parameterization with Free Boundaries", SIGGRAPH 2015; Li
// et al., "Incremental Potential Contact", SIGGRAPH 2020.
#include "core/optimize/border_contact.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numerics/box_tree.h"
#include "core/numerics/polygon.h"
#include "core/numerics/quadratic.h"
#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

/// Of the mean border edge.
constexpr double clearance_share = 0.01;
/// Pressure of the barrier, in units of the energy density.
constexpr double stiffness = 0.1;

/// A distance with its derivatives by (a, b, p).
struct Distance {
    double value;
    Vector6 gradient = Vector6::Zero();
    Matrix6 hessian = Matrix6::Zero();
};

/// Adds the derivatives of |q - p| times `factor` for the points i and j of six.
void add_length(const Vec2& unit, double length, Eigen::Index i, Eigen::Index j, Distance& d) {
    d.gradient.segment<2>(i) = unit;
    d.gradient.segment<2>(j) = -unit;
    const Eigen::Matrix2d bend = (Eigen::Matrix2d::Identity() - unit * unit.transpose()) / length;
    d.hessian.block<2, 2>(i, i) = bend;
    d.hessian.block<2, 2>(j, j) = bend;
    d.hessian.block<2, 2>(i, j) = -bend;
    d.hessian.block<2, 2>(j, i) = -bend;
}

Distance between_points(const Vec2& p, const Vec2& q, Eigen::Index i, Eigen::Index j) {
    Distance d{(p - q).norm()};
    add_length((p - q) / d.value, d.value, i, j, d);
    return d;
}

/// Distance to the line: the cross product over the edge's length.
Distance to_line(const Vec2& a, const Vec2& b, const Vec2& p) {
    Distance length{(b - a).norm()};
    add_length((b - a) / length.value, length.value, 2, 0, length);
    const double doubled = cross(b - a, p - a), sign = doubled < 0.0 ? -1.0 : 1.0;
    Vector6 area;
    area << b.y() - p.y(), p.x() - b.x(), p.y() - a.y(), a.x() - p.x(), a.y() - b.y(),
        b.x() - a.x();
    Matrix6 area_hessian = Matrix6::Zero();
    const auto turn = [&](Eigen::Index i, Eigen::Index j) {  // of cross(point i, point j)
        area_hessian(i, j + 1) += 1.0;
        area_hessian(j + 1, i) += 1.0;
        area_hessian(i + 1, j) -= 1.0;
        area_hessian(j, i + 1) -= 1.0;
    };
    turn(0, 2);
    turn(2, 4);
    turn(4, 0);
    const double l = length.value;
    const Vector6& dl = length.gradient;
    Distance d{std::abs(doubled) / l};
    d.gradient = sign * (area / l - doubled / (l * l) * dl);
    d.hessian =
        sign *
        (area_hessian / l - (area * dl.transpose() + dl * area.transpose()) / (l * l) -
         doubled / (l * l) * length.hessian + 2.0 * doubled / (l * l * l) * dl * dl.transpose());
    return d;
}

/// Where along a..b the point nearest to p lies: below 0 and above 1 it is an end.
double foot(const Vec2& a, const Vec2& b, const Vec2& p) {
    const double length = (b - a).squaredNorm();
    return length > 0.0 ? (p - a).dot(b - a) / length : 0.0;
}

double distance_value(const Vec2& a, const Vec2& b, const Vec2& p) {
    return (p - a - std::clamp(foot(a, b, p), 0.0, 1.0) * (b - a)).norm();
}

Distance distance_to_edge(const Vec2& a, const Vec2& b, const Vec2& p) {
    const double t = foot(a, b, p);
    if (t <= 0.0) return between_points(p, a, 4, 0);
    if (t >= 1.0) return between_points(p, b, 4, 2);
    return to_line(a, b, p);
}

/// -(t - 1)^2 ln t for t < 1 with its derivatives.
struct Barrier {
    double value, first, second;
};

Barrier barrier(double t) {
    if (t <= 0.0) return {infinity, -infinity, infinity};
    if (t >= 1.0) return {0.0, 0.0, 0.0};
    const double s = t - 1.0, logarithm = std::log(t);
    return {-s * s * logarithm, -2.0 * s * logarithm - s * s / t,
            -2.0 * logarithm - 4.0 * s / t + s * s / (t * t)};
}

/// The first time in [0, 1] at which p meets the edge; infinite if it does not.
double meeting_time(const std::array<Vec2, 3>& from, const std::array<Vec2, 3>& motion) {
    const Vec2 e = from[1] - from[0], de = motion[1] - motion[0];
    const Vec2 q = from[2] - from[0], dq = motion[2] - motion[0];
    const double a = cross(de, dq), b = cross(de, q) + cross(e, dq), c = cross(e, q);
    auto roots = quadratic_roots(a, b, c);
    std::sort(roots.begin(), roots.end());
    for (const double t : roots) {
        if (!(t >= 0.0 && t <= 1.0)) continue;
        const double where =
            foot(from[0] + t * motion[0], from[1] + t * motion[1], from[2] + t * motion[2]);
        if (where >= -tolerance::passed_corner && where <= 1.0 + tolerance::passed_corner) return t;
    }
    return infinity;
}

}  // namespace

BorderContact::BorderContact(const Domain& domain)
    : domain_(domain), weight_(static_cast<std::size_t>(domain.vertices()), 0.0) {
    double total = 0.0;
    std::size_t edges = 0;
    for (std::size_t r = 0; r < domain.regions.size(); ++r) {
        for (const auto& border : border_loops(*domain.regions[r])) {
            const auto lengths = loop_lengths(*domain.regions[r], border);
            Loop loop{border, {0.0}, {}};
            for (Index& v : loop.vertices) v += domain.first[r];
            for (std::size_t i = 0; i < lengths.size(); ++i) {
                const double before = lengths[(i + lengths.size() - 1) % lengths.size()];
                loop.lengths.push_back(0.5 * (before + lengths[i]));
                loop.along.push_back(loop.along.back() + lengths[i]);
                total += lengths[i];
                ++edges;
            }
            loops_.push_back(std::move(loop));
        }
    }
    clearance_ = clearance_share * total / static_cast<double>(edges);
    for (const Loop& loop : loops_) {
        for (std::size_t i = 0; i < loop.vertices.size(); ++i)
            weight_[static_cast<std::size_t>(loop.vertices[i])] =
                stiffness * clearance_ * loop.lengths[i];
    }
}

/// Calls visit(loop, vertex, edge) for those that may come nearer than `distance` on the way.
template <class Visit>
void BorderContact::for_candidates(const Eigen::VectorXd& x, const Eigen::VectorXd& to,
                                   double distance, const Visit& visit) const {
    for (const Loop& loop : loops_) {
        const std::size_t n = loop.vertices.size();
        std::vector<Box2> paths(n), edges(n);
        for (std::size_t i = 0; i < n; ++i) {
            paths[i].extend(point(x, loop.vertices[i]));
            paths[i].extend(point(to, loop.vertices[i]));
        }
        for (std::size_t i = 0; i < n; ++i) edges[i] = paths[i].merged(paths[(i + 1) % n]);
        const BoxTree<Box2> tree(edges);
        for (std::size_t i = 0; i < n; ++i) {
            Box2 box = paths[i];
            box.min().array() -= distance;
            box.max().array() += distance;
            tree.find(box, [&](Index e) {
                const std::size_t first = static_cast<std::size_t>(e), second = (first + 1) % n;
                if (first != i && second != i) visit(loop, i, first);
                return false;
            });
        }
    }
}

double BorderContact::clearance_of(const Loop& loop, std::size_t vertex, std::size_t edge) const {
    const std::size_t next = (edge + 1) % loop.vertices.size();
    const double round = loop.along.back();
    const auto way = [&](std::size_t other) {
        const double direct = std::abs(loop.along[vertex] - loop.along[other]);
        return std::min(direct, round - direct);
    };
    const double along = std::min(way(edge), way(next));
    const Vec3& p = domain_.position(loop.vertices[vertex]);
    const Vec3& a = domain_.position(loop.vertices[edge]);
    const Vec3 e = domain_.position(loop.vertices[next]) - a;
    const double t = std::clamp((p - a).dot(e) / e.squaredNorm(), 0.0, 1.0);
    const double across = (p - a - t * e).norm();
    double clearance = std::min(clearance_, 0.25 * along);
    if (across > tolerance::slit_width * clearance) clearance = std::min(clearance, 0.5 * across);
    return clearance;
}

std::vector<ContactPair> BorderContact::near_pairs(const Eigen::VectorXd& x,
                                                   double multiple) const {
    std::vector<ContactPair> pairs;
    for_candidates(
        x, x, multiple * clearance_, [&](const Loop& loop, std::size_t vertex, std::size_t edge) {
            const std::size_t next = (edge + 1) % loop.vertices.size();
            const Index p = loop.vertices[vertex], a = loop.vertices[edge], b = loop.vertices[next];
            const double distance = distance_value(point(x, a), point(x, b), point(x, p));
            if (distance >= multiple * clearance_) return;
            const double clearance = clearance_of(loop, vertex, edge);
            if (distance < multiple * clearance) pairs.push_back({p, a, b, clearance});
        });
    return pairs;
}

double BorderContact::value(const Eigen::VectorXd& x) const {
    double sum = 0.0;
    const auto pairs = near_pairs(x);
    for (const ContactPair& pair : pairs) {
        const double d = distance_value(point(x, pair.a), point(x, pair.b), point(x, pair.point));
        sum += weight_[static_cast<std::size_t>(pair.point)] * barrier(d / pair.clearance).value;
    }
    // In contact round-off may let a vertex slip through.
    if (!pairs.empty() && crosses(x)) return infinity;
    return sum;
}

bool BorderContact::crosses(const Eigen::VectorXd& x) const {
    return std::any_of(loops_.begin(), loops_.end(), [&](const Loop& loop) {
        Points2 outline;
        for (const Index v : loop.vertices) outline.push_back(point(x, v));
        return !self_crossings(outline).empty();
    });
}

void BorderContact::add_gradient(const Eigen::VectorXd& x, Eigen::VectorXd& gradient) const {
    for (const ContactPair& pair : near_pairs(x)) {
        const Distance d =
            distance_to_edge(point(x, pair.a), point(x, pair.b), point(x, pair.point));
        const double slope = weight_[static_cast<std::size_t>(pair.point)] *
                             barrier(d.value / pair.clearance).first / pair.clearance;
        gradient.segment<2>(2 * pair.a) += slope * d.gradient.segment<2>(0);
        gradient.segment<2>(2 * pair.b) += slope * d.gradient.segment<2>(2);
        gradient.segment<2>(2 * pair.point) += slope * d.gradient.segment<2>(4);
    }
}

Matrix6 BorderContact::pair_hessian(const ContactPair& pair, const Eigen::VectorXd& x,
                                    HessianKind kind) const {
    const Distance d = distance_to_edge(point(x, pair.a), point(x, pair.b), point(x, pair.point));
    const Barrier b = barrier(d.value / pair.clearance);
    Matrix6 hessian =
        weight_[static_cast<std::size_t>(pair.point)] *
        (b.second / (pair.clearance * pair.clearance) * d.gradient * d.gradient.transpose() +
         b.first / pair.clearance * d.hessian);
    if (kind == HessianKind::exact) return hessian;
    const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(hessian);
    return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() *
           eigen.eigenvectors().transpose();
}

std::vector<VertexPair> BorderContact::passing_pairs(const Eigen::VectorXd& x, double reach) const {
    std::vector<VertexPair> pairs;
    for (const ContactPair& pair : near_pairs(x, reach)) {
        pairs.emplace_back(pair.point, pair.a);
        pairs.emplace_back(pair.point, pair.b);
    }
    return pairs;
}

void BorderContact::for_hessian(const Eigen::VectorXd& x, HessianKind kind,
                                const TakeHessian& take) const {
    for (const ContactPair& pair : near_pairs(x))
        take_ascending({pair.a, pair.b, pair.point}, pair_hessian(pair, x, kind), take);
}

/// When a border vertex first meets an edge, if within that part of the way; else infinite.
double BorderContact::first_meeting(const Eigen::VectorXd& x, const Eigen::VectorXd& d,
                                    double part) const {
    double least = infinity;
    for_candidates(x, x + part * d, 0.0,
                   [&](const Loop& loop, std::size_t vertex, std::size_t edge) {
                       const Index p = loop.vertices[vertex], a = loop.vertices[edge],
                                   b = loop.vertices[(edge + 1) % loop.vertices.size()];
                       const double t = meeting_time({point(x, a), point(x, b), point(x, p)},
                                                     {point(d, a), point(d, b), point(d, p)});
                       if (t <= part) least = std::min(least, t);
                   });
    return least;
}

double BorderContact::largest_step(const Eigen::VectorXd& x, const Eigen::VectorXd& d) const {
    // Of a long way first the beginning: there few pairs come into question.
    constexpr double shortest = 1e-9, longer = 8.0;
    const double mean_edge = clearance_ / clearance_share;
    for (double part = std::clamp(mean_edge / d.lpNorm<Eigen::Infinity>(), shortest, 1.0);;
         part = std::min(1.0, longer * part)) {
        const double t = first_meeting(x, d, part);
        if (t < infinity) return 0.9 * t;
        if (part == 1.0) return 1.0;
    }
}

}  // namespace lastflat
