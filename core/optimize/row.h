// One equation or bound on the points.
#pragma once

#include <cmath>
#include <variant>

#include "core/numerics/polygon.h"
#include "core/optimize/domain.h"
#include "core/optimize/energy_term.h"

namespace lastflat {

/// A block of a Hessian, at the rows of one vertex and the columns of another.
using TakeBlock = std::function<void(Index row, Index column, const Eigen::Matrix2d& block)>;

// The kinds of terms of a row: each with its vertices, its value, its gradient by each of them, and
// its Hessian times a weight. `o` is the row's origin.

/// |x_a - x_b|, mm.
struct Length {
    Index a, b;
    bool operator==(const Length&) const = default;
    [[nodiscard]] std::array<Index, 2> vertices() const { return {a, b}; }
    [[nodiscard]] double value(const Eigen::VectorXd& x, const Vec2& /*o*/) const {
        return (point(x, a) - point(x, b)).norm();
    }
    [[nodiscard]] std::array<Vec2, 2> gradient(const Eigen::VectorXd& x, const Vec2& /*o*/) const {
        const Vec2 unit = (point(x, a) - point(x, b)).normalized();
        return {unit, -unit};
    }
    /// An edge that turns grows longer by second order; under compression (a negative weight) that
    /// lowers the energy, which a projected system drops.
    void for_hessian(const Eigen::VectorXd& x, double weight, HessianKind kind,
                     const TakeBlock& take) const {
        if (kind == HessianKind::projected && weight <= 0.0) return;
        const Vec2 along = point(x, a) - point(x, b);
        const double length = along.norm();
        const Vec2 unit = along / length;
        const Eigen::Matrix2d bend =
            weight / length * (Eigen::Matrix2d::Identity() - unit * unit.transpose());
        take(a, a, bend);
        take(b, b, bend);
        take(a, b, -bend);
    }
};

/// x_a cross x_b, mm^2.
struct Cross {
    Index a, b;
    bool operator==(const Cross&) const = default;
    [[nodiscard]] std::array<Index, 2> vertices() const { return {a, b}; }
    [[nodiscard]] double value(const Eigen::VectorXd& x, const Vec2& o) const {
        return cross(point(x, a) - o, point(x, b) - o);
    }
    [[nodiscard]] std::array<Vec2, 2> gradient(const Eigen::VectorXd& x, const Vec2& o) const {
        const Vec2 p = point(x, a) - o, q = point(x, b) - o;
        return {Vec2(q.y(), -q.x()), Vec2(-p.y(), p.x())};
    }
    void for_hessian(const Eigen::VectorXd& /*x*/, double weight, HessianKind kind,
                     const TakeBlock& take) const {
        if (kind == HessianKind::projected) return;
        take(a, b, (Eigen::Matrix2d() << 0.0, weight, -weight, 0.0).finished());
    }
};

/// Coordinate `axis` (0 or 1) of a vertex, mm.
struct Coordinate {
    Index vertex, axis;
    bool operator==(const Coordinate&) const = default;
    [[nodiscard]] std::array<Index, 1> vertices() const { return {vertex}; }
    [[nodiscard]] double value(const Eigen::VectorXd& x, const Vec2& /*o*/) const {
        return x[2 * vertex + axis];
    }
    [[nodiscard]] std::array<Vec2, 1> gradient(const Eigen::VectorXd& /*x*/,
                                               const Vec2& /*o*/) const {
        return {Vec2::Unit(axis)};
    }
    void for_hessian(const Eigen::VectorXd& /*x*/, double /*weight*/, HessianKind /*kind*/,
                     const TakeBlock& /*take*/) const {}
};

struct RowTerm {
    double factor;
    std::variant<Length, Cross, Coordinate> of;
    bool operator==(const RowTerm&) const = default;
};

/// The sum of the terms shall lie between `least` and `most`, mm.
struct Row {
    std::vector<RowTerm> terms;
    double least, most;
    double reference;         ///< mm, what its error is a share of
    Index vertex;             ///< one of the terms' that stands for it
    double compliance = 0.0;  ///< mm of error for a force of 1 mm; 0: it is kept exactly

    [[nodiscard]] bool is_equation() const { return least == most; }
    [[nodiscard]] bool is_soft() const { return compliance > 0.0; }

    /// Cross products are taken from here, near the row's points, so that they keep their digits
    /// wherever the chart lies; their sum around a polygon is the same from everywhere.
    [[nodiscard]] Vec2 origin(const Eigen::VectorXd& x) const { return point(x, vertex); }

    /// If it holds a coordinate of its vertex: which. Else null.
    [[nodiscard]] const Coordinate* coordinate() const {
        return std::get_if<Coordinate>(&terms.front().of);
    }

    /// Of all terms, ascending.
    [[nodiscard]] std::vector<Index> vertices() const;

    [[nodiscard]] double value(const Eigen::VectorXd& x) const;

    /// What is missing, with its sign: above `most` positive, below `least` negative, else zero.
    [[nodiscard]] double violation(double value) const {
        return value > most ? value - most : value < least ? value - least : 0.0;
    }

    /// As a share of its reference, without the sign.
    [[nodiscard]] double relative_error(double value) const {
        return std::abs(violation(value)) / reference;
    }

    /// Calls take(vertex, factor, gradient) for the gradient of every term by its vertices.
    template <class Take>
    void for_gradient(const Eigen::VectorXd& x, const Take& take) const {
        const Vec2 o = origin(x);
        for (const RowTerm& term : terms) {
            std::visit(
                [&](const auto& of) {
                    const auto vertices = of.vertices();
                    const auto gradient = of.gradient(x, o);
                    for (std::size_t i = 0; i < vertices.size(); ++i)
                        take(vertices[i], term.factor, gradient[i]);
                },
                term.of);
        }
    }

    /// The Hessian times the multiplier, block by block, of the pairs that it couples once each.
    void for_hessian(const Eigen::VectorXd& x, double multiplier, HessianKind kind,
                     const TakeBlock& take) const;
};

[[nodiscard]] Eigen::VectorXd values_of(const std::vector<Row>& rows, const Eigen::VectorXd& x);

/// Adds every row's gradient times its multiplier.
void add_forces(const std::vector<Row>& rows, const Eigen::VectorXd& x,
                const Eigen::VectorXd& multipliers, Eigen::VectorXd& gradient);

}  // namespace lastflat
