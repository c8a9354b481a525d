// Based on: Vanderbei, "Symmetric Quasidefinite Matrices", SIAM J. Optimization 1995; Nocedal,
// Wright, "Numerical Optimization", 2006, chapter 18.
#include "core/constrain/optimality_system.h"

#include <algorithm>
#include <array>
#include <span>

#include "core/error.h"
#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

using Block = std::pair<Index, Index>;  ///< (column vertex, row vertex)

/// Every vertex with itself and every two that share an edge, by column.
std::vector<Block> vertex_blocks(const Region& region) {
    std::vector<Block> blocks;
    for (const Triangle& t : region.triangles) {
        for (std::size_t i = 0; i < 3; ++i) blocks.push_back(std::minmax(t[i], t[(i + 1) % 3]));
    }
    for (Index v = 0; v < static_cast<Index>(region.positions.size()); ++v)
        blocks.emplace_back(v, v);
    std::sort(blocks.begin(), blocks.end());
    blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
    return blocks;
}

/// Per vertex, the constraints that it takes part in, ascending.
std::vector<std::vector<Index>> constraints_by_vertex(
    const Region& region, const std::vector<LengthConstraint>& constraints) {
    std::vector<std::vector<Index>> result(region.positions.size());
    for (std::size_t k = 0; k < constraints.size(); ++k) {
        const auto constraint = static_cast<Index>(k);
        for (const auto& [a, b] : constraints[k].edges) {
            for (const Index v : {a, b}) {
                auto& list = result[static_cast<std::size_t>(v)];
                if (list.empty() || list.back() != constraint) list.push_back(constraint);
            }
        }
    }
    return result;
}

/// The lower triangle's pattern, all values zero: a 2x2 block for every edge and vertex, a row for
/// every constraint.
SparseMatrix pattern(const Region& region, const std::vector<LengthConstraint>& constraints) {
    const auto n = static_cast<Index>(region.positions.size());
    const auto m = static_cast<Index>(constraints.size());
    const auto blocks = vertex_blocks(region);
    const auto constraints_at = constraints_by_vertex(region, constraints);
    SparseMatrix matrix(2 * n + m, 2 * n + m);
    matrix.reserve(static_cast<Eigen::Index>(4 * blocks.size()) + 4 * m);
    std::size_t next = 0;
    for (Index column = 0; column < 2 * n; ++column) {
        const Index v = column / 2, side = column % 2;
        matrix.startVec(column);
        std::size_t i = next;
        for (; i < blocks.size() && blocks[i].first == v; ++i) {
            const Index w = blocks[i].second;
            for (Index k = w == v ? side : 0; k < 2; ++k) {
                matrix.insertBackByOuterInner(column, 2 * w + k) = 0.0;
            }
        }
        for (const Index constraint : constraints_at[static_cast<std::size_t>(v)]) {
            matrix.insertBackByOuterInner(column, 2 * n + constraint) = 0.0;
        }
        if (side == 1) next = i;
    }
    for (Index k = 0; k < m; ++k) {
        matrix.startVec(2 * n + k);
        matrix.insertBackByOuterInner(2 * n + k, 2 * n + k) = 0.0;
    }
    matrix.finalize();
    return matrix;
}

/// Three coordinates that hold the chart in place: both of one vertex, and of the vertex furthest
/// from it the one across the line between them. A rigid motion costs nothing, so holding it takes
/// nothing from the step; left free, its curvature away from the minimum may be negative. Where the
/// scale is free as well, the fourth holds it.
std::vector<Index> pinned_coordinates(const Eigen::VectorXd& x, bool scale_free) {
    Index far = 0;
    double largest = -1.0;
    for (Index v = 1; 2 * v < x.size(); ++v) {
        const double distance = (x.segment<2>(2 * v) - x.head<2>()).squaredNorm();
        if (distance <= largest) continue;
        largest = distance;
        far = v;
    }
    const Vec2 between = (x.segment<2>(2 * far) - x.head<2>()).cwiseAbs();
    if (scale_free) return {0, 1, 2 * far, 2 * far + 1};
    return {0, 1, 2 * far + (between.x() > between.y() ? 1 : 0)};
}

}  // namespace

OptimalitySystem::OptimalitySystem(const Region& region,
                                   const std::vector<LengthConstraint>& constraints,
                                   Distortion& distortion)
    : constraints_(constraints),
      distortion_(distortion),
      unknowns_(2 * static_cast<Index>(region.positions.size())),
      matrix_(pattern(region, constraints)) {
    distortion_.bind(matrix_);
    solver_.analyse(matrix_);
}

double& OptimalitySystem::entry(Index row, Index column) {
    const auto* begin = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[column];
    const auto* end = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[column + 1];
    return matrix_.valuePtr()[std::lower_bound(begin, end, row) - matrix_.innerIndexPtr()];
}

Eigen::VectorXd OptimalitySystem::residual(const Eigen::VectorXd& x) const {
    Eigen::VectorXd c(static_cast<Eigen::Index>(constraints_.size()));
    for (Eigen::Index k = 0; k < c.size(); ++k) {
        const auto& constraint = constraints_[static_cast<std::size_t>(k)];
        c[k] = flat_length(constraint, x) - constraint.length;
    }
    return c;
}

/// Gradient: the unit vectors along the edges. Hessian: an edge that turns grows longer by second
/// order; under compression (multiplier < 0) that lowers the energy, which a projected system
/// drops.
void OptimalitySystem::add_constraint(Index row, const Eigen::VectorXd& x, double multiplier,
                                      HessianKind kind) {
    const double weight = kind == HessianKind::exact ? multiplier : std::max(multiplier, 0.0);
    for (const auto& [a, b] : constraints_[static_cast<std::size_t>(row - unknowns_)].edges) {
        const Vec2 along = x.segment<2>(2 * a) - x.segment<2>(2 * b);
        const double length = along.norm();
        const Vec2 unit = along / length;
        const Eigen::Matrix2d bend =
            weight / length * (Eigen::Matrix2d::Identity() - unit * unit.transpose());
        for (Index i = 0; i < 2; ++i) {
            entry(row, 2 * a + i) += unit[i];
            entry(row, 2 * b + i) -= unit[i];
            for (Index j = 0; j < 2; ++j) {
                if (j <= i) {
                    entry(2 * a + i, 2 * a + j) += bend(i, j);
                    entry(2 * b + i, 2 * b + j) += bend(i, j);
                }
                entry(2 * std::max(a, b) + i, 2 * std::min(a, b) + j) -= bend(i, j);
            }
        }
    }
}

double OptimalitySystem::fill(const Eigen::VectorXd& x, const Eigen::VectorXd& multipliers,
                              HessianKind kind) {
    std::fill_n(matrix_.valuePtr(), matrix_.nonZeros(), 0.0);
    gradient_ = distortion_.differentiate(x, kind, matrix_);
    double trace = 0.0;
    for (Index i = 0; i < unknowns_; ++i) trace += entry(i, i);
    const double mean = trace / unknowns_;
    for (const Index i : pinned_coordinates(x, distortion_.scale_free()))
        entry(i, i) += tolerance::pin * mean;
    regularisation_ = tolerance::multiplier_regularisation / mean;
    for (Index k = 0; k < static_cast<Index>(constraints_.size()); ++k) {
        add_constraint(unknowns_ + k, x, multipliers[k], kind);
        entry(unknowns_ + k, unknowns_ + k) = -regularisation_;
    }
    return mean;
}

void OptimalitySystem::shift_diagonal(double amount) {
    for (Index i = 0; i < unknowns_; ++i) entry(i, i) += amount;
}

bool OptimalitySystem::has_right_inertia() {
    return solver_.factor(matrix_) &&
           solver_.negative_pivots() == static_cast<Index>(constraints_.size());
}

void OptimalitySystem::factor(const Eigen::VectorXd& x, const Eigen::VectorXd& multipliers,
                              HessianKind kind) {
    // A shift of the diagonal shortens the step but moves no minimum. An exact Hessian may need
    // much of it where a locked curve is about to buckle, a projected one only against round-off.
    static constexpr std::array exact_shifts{tolerance::rigid_motion, 1e-4, 1e-3, 1e-2, 1e-1};
    static constexpr std::array projected_shifts{tolerance::rigid_motion, 1e-7, 1e-5, 1e-3};
    const auto attempt = [&](HessianKind attempted, std::span<const double> shifts) {
        const double mean = fill(x, multipliers, attempted);
        double shifted = 0.0;
        for (const double shift : shifts) {
            shift_diagonal((shift - shifted) * mean);
            shifted = shift;
            if (has_right_inertia()) return true;
        }
        return false;
    };
    if (kind == HessianKind::exact && attempt(HessianKind::exact, exact_shifts)) return;
    if (attempt(HessianKind::projected, projected_shifts)) return;
    throw Error(ErrorCode::solver_failed, "a Newton step could not be computed");
}

Eigen::VectorXd OptimalitySystem::solve(const Eigen::VectorXd& top,
                                        const Eigen::VectorXd& bottom) const {
    Eigen::VectorXd right(top.size() + bottom.size());
    right << top, bottom;
    Eigen::VectorXd solution = solver_.solve(right);
    for (int refinement = 0; refinement < 2; ++refinement) {
        Eigen::VectorXd rest = right - matrix_.selfadjointView<Eigen::Lower>() * solution;
        rest.tail(bottom.size()) -= regularisation_ * solution.tail(bottom.size());
        solution += solver_.solve(rest);
    }
    return solution;
}

}  // namespace lastflat
