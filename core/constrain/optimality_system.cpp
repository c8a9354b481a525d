// Based on: Vanderbei, "Symmetric Quasidefinite Matrices", SIAM J. Optimization 1995; Nocedal,
// Wright, "Numerical Optimization", 2006, chapter 18.
#include "core/constrain/optimality_system.h"

#include <algorithm>
#include <array>
#include <limits>
#include <span>

#include "core/error.h"
#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

std::vector<Index> vertices_of(const ConstraintRow& row) {
    std::vector<Index> vertices;
    for (const Term& term : row.terms) {
        vertices.push_back(term.a);
        if (term.kind != TermKind::coordinate) vertices.push_back(term.b);
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

/// Places of the vertices for the dissection: flat, where a plane cuts a folded surface but once;
/// the regions far from each other, so that the first planes run between them.
Points2 spread_positions(const Domain& domain, const Eigen::VectorXd& x) {
    Points2 positions;
    positions.reserve(at(domain.vertices()));
    const double apart = 10.0 * x.cwiseAbs().maxCoeff();
    for (std::size_t r = 0; r < domain.regions.size(); ++r) {
        const Vec2 offset(static_cast<double>(r) * apart, 0.0);
        for (Index v = domain.first[r]; v < domain.first[r + 1]; ++v)
            positions.emplace_back(x.segment<2>(2 * v) + offset);
    }
    return positions;
}

/// The last block that both are in or below: the deepest common ancestor, or `none`.
Index common_block(const std::vector<UnknownBlock>& blocks, Index a, Index b, Index none) {
    while (a != b) {  // parents come after their children
        Index& lower = a < b ? a : b;
        lower = blocks[at(lower)].parent;
        if (lower < 0) return none;
    }
    return a;
}

}  // namespace

OptimalitySystem::OptimalitySystem(const Domain& domain, const std::vector<ConstraintRow>& rows,
                                   const std::vector<double>& compliance, Distortion& distortion,
                                   const BorderContact* contact, const StiffCurves* stiff_curves,
                                   const Eigen::VectorXd& x, std::size_t threads,
                                   const Progress& progress)
    : domain_(domain),
      rows_(rows),
      compliance_(compliance),
      distortion_(distortion),
      contact_(contact),
      stiff_curves_(stiff_curves),
      threads_(threads),
      progress_(progress),
      unknowns_(2 * domain.vertices()),
      positions_(spread_positions(domain, x)) {
    analyse();
}

void OptimalitySystem::analyse() {
    const VertexGraph graph = vertex_graph(domain_.vertices(), vertex_pairs());
    matrix_ = pattern(graph);
    distortion_.bind(matrix_);
    solver_.analyse(matrix_, elimination_blocks(graph));
}

void OptimalitySystem::prepare(const Eigen::VectorXd& x) {
    constexpr double soon = 3.0;
    if (contact_ == nullptr) return;
    const auto add = [&](double multiple) {
        const std::size_t before = contacts_.size();
        for (const ContactPair& pair : contact_->near_pairs(x, multiple)) {
            contacts_.insert(std::minmax(pair.point, pair.a));
            contacts_.insert(std::minmax(pair.point, pair.b));
        }
        return contacts_.size() > before;
    };
    if (!add(1.0)) return;
    add(soon);
    analyse();
}

/// Every two vertices that share an edge, a constraint's bend or a contact, the smaller first; with
/// repeats.
std::vector<OptimalitySystem::VertexPair> OptimalitySystem::vertex_pairs() const {
    std::vector<VertexPair> pairs(contacts_.begin(), contacts_.end());
    for (std::size_t r = 0; r < domain_.regions.size(); ++r) {
        const Index first = domain_.first[r];
        for (const Triangle& t : domain_.regions[r]->triangles) {
            for (std::size_t i = 0; i < 3; ++i) {
                const auto [a, b] = std::minmax(t[i], t[(i + 1) % 3]);
                pairs.emplace_back(a + first, b + first);
            }
        }
    }
    if (stiff_curves_ != nullptr) {
        const auto bends = stiff_curves_->vertex_pairs();
        pairs.insert(pairs.end(), bends.begin(), bends.end());
    }
    for (const ConstraintRow& row : rows_) {
        for (const Term& term : row.terms) {
            if (term.kind != TermKind::coordinate) pairs.push_back(std::minmax(term.a, term.b));
        }
    }
    return pairs;
}

/// The lower triangle's pattern, all values zero: a 2x2 block for every edge of the graph and every
/// vertex, a row for every constraint.
SparseMatrix OptimalitySystem::pattern(const VertexGraph& graph) const {
    const Index n = domain_.vertices();
    const auto m = static_cast<Index>(rows_.size());
    std::vector<std::vector<Index>> rows_at(at(n));
    for (Index k = 0; k < m; ++k) {
        for (const Index v : vertices_of(rows_[at(k)])) rows_at[at(v)].push_back(2 * n + k);
    }
    SparseMatrix matrix(2 * n + m, 2 * n + m);
    matrix.reserve(static_cast<Eigen::Index>(2 * graph.neighbours.size()) + 4 * n + 8 * m);
    for (Index v = 0; v < n; ++v) {
        for (Index side = 0; side < 2; ++side) {
            const Index column = 2 * v + side;
            matrix.startVec(column);
            for (Index i = side; i < 2; ++i) matrix.insertBackByOuterInner(column, 2 * v + i) = 0.0;
            for (Index e = graph.begin[at(v)]; e < graph.begin[at(v) + 1]; ++e) {
                const Index w = graph.neighbours[at(e)];
                if (w < v) continue;
                for (Index i = 0; i < 2; ++i)
                    matrix.insertBackByOuterInner(column, 2 * w + i) = 0.0;
            }
            for (const Index row : rows_at[at(v)]) matrix.insertBackByOuterInner(column, row) = 0.0;
        }
    }
    for (Index k = 0; k < m; ++k) {
        matrix.startVec(2 * n + k);
        matrix.insertBackByOuterInner(2 * n + k, 2 * n + k) = 0.0;
    }
    matrix.finalize();
    return matrix;
}

/// Both coordinates of the dissection's vertices. A multiplier comes after all vertices of its
/// row, in the block where the last of them are: before them its pivot would be next to nothing.
std::vector<UnknownBlock> OptimalitySystem::elimination_blocks(const VertexGraph& graph) const {
    const auto dissection = nested_dissection(graph, positions_);
    std::vector<UnknownBlock> blocks(dissection.size());
    std::vector<Index> block_of(at(domain_.vertices()));
    for (std::size_t b = 0; b < dissection.size(); ++b) {
        blocks[b].parent = dissection[b].parent;
        for (const Index v : dissection[b].vertices) {
            block_of[at(v)] = static_cast<Index>(b);
            for (const Index i : {2 * v, 2 * v + 1}) blocks[b].unknowns.push_back(i);
        }
    }
    std::vector<Index> across;  // rows whose vertices have no block in common
    for (Index k = 0; k < static_cast<Index>(rows_.size()); ++k) {
        const auto vertices = vertices_of(rows_[at(k)]);
        Index block = block_of[at(vertices.front())];
        for (const Index v : vertices) {
            if (block >= 0) block = common_block(blocks, block, block_of[at(v)], -1);
        }
        (block < 0 ? across : blocks[at(block)].unknowns).push_back(unknowns_ + k);
    }
    if (!across.empty()) {
        const auto top = static_cast<Index>(blocks.size());
        for (UnknownBlock& block : blocks) {
            if (block.parent < 0) block.parent = top;
        }
        blocks.push_back({-1, across});
    }
    return blocks;
}

double& OptimalitySystem::entry(Index row, Index column) {
    const auto* begin = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[column];
    const auto* end = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[column + 1];
    return matrix_.valuePtr()[std::lower_bound(begin, end, row) - matrix_.innerIndexPtr()];
}

/// Adds a block of the Hessian at rows of vertex a, columns of vertex b, and its mirror image.
void OptimalitySystem::add_block(Index a, Index b, const Eigen::Matrix2d& block) {
    for (Index i = 0; i < 2; ++i) {
        for (Index j = 0; j < 2; ++j) {
            if (a == b && j > i) continue;
            if (a >= b)
                entry(2 * a + i, 2 * b + j) += block(i, j);
            else
                entry(2 * b + j, 2 * a + i) += block(i, j);
        }
    }
}

/// Gradient and Hessian of one term. An edge that turns grows longer by second order; under
/// compression (a negative multiplier) that lowers the energy, which a projected system drops.
void OptimalitySystem::add_term(Index row, const Term& term, const Eigen::VectorXd& x,
                                double multiplier, HessianKind kind) {
    const double weight = multiplier * term.factor;
    const Vec2 o = rows_[at(row - unknowns_)].origin(x);
    const Vec2 a = x.segment<2>(2 * term.a);
    switch (term.kind) {
        case TermKind::coordinate: entry(row, 2 * term.a + term.b) += term.factor; return;
        case TermKind::length: {
            const Vec2 along = a - x.segment<2>(2 * term.b);
            const double length = along.norm();
            const Vec2 unit = along / length;
            for (Index i = 0; i < 2; ++i) {
                entry(row, 2 * term.a + i) += term.factor * unit[i];
                entry(row, 2 * term.b + i) -= term.factor * unit[i];
            }
            if (kind == HessianKind::projected && weight <= 0.0) return;
            const Eigen::Matrix2d bend =
                weight / length * (Eigen::Matrix2d::Identity() - unit * unit.transpose());
            add_block(term.a, term.a, bend);
            add_block(term.b, term.b, bend);
            add_block(term.a, term.b, -bend);
            return;
        }
        case TermKind::cross: {
            const Vec2 p = a - o, q = x.segment<2>(2 * term.b) - o;
            entry(row, 2 * term.a) += term.factor * q.y();
            entry(row, 2 * term.a + 1) -= term.factor * q.x();
            entry(row, 2 * term.b) -= term.factor * p.y();
            entry(row, 2 * term.b + 1) += term.factor * p.x();
            if (kind == HessianKind::projected) return;
            Eigen::Matrix2d turn;
            turn << 0.0, weight, -weight, 0.0;
            add_block(term.a, term.b, turn);
            return;
        }
    }
}

void OptimalitySystem::add_forces(const Eigen::VectorXd& x, const Eigen::VectorXd& multipliers,
                                  Eigen::VectorXd& gradient) const {
    for (std::size_t k = 0; k < rows_.size(); ++k) {
        const Vec2 o = rows_[k].origin(x);
        for (const Term& term : rows_[k].terms) {
            const double weight = multipliers[static_cast<Eigen::Index>(k)] * term.factor;
            const Vec2 a = x.segment<2>(2 * term.a);
            if (term.kind == TermKind::coordinate) {
                gradient[2 * term.a + term.b] += weight;
                continue;
            }
            const Vec2 b = x.segment<2>(2 * term.b);
            if (term.kind == TermKind::length) {
                const Vec2 unit = weight * (a - b).normalized();
                gradient.segment<2>(2 * term.a) += unit;
                gradient.segment<2>(2 * term.b) -= unit;
            } else {
                gradient.segment<2>(2 * term.a) += weight * Vec2(b.y() - o.y(), o.x() - b.x());
                gradient.segment<2>(2 * term.b) += weight * Vec2(o.y() - a.y(), a.x() - o.x());
            }
        }
    }
}

/// Stiffens three coordinates of every region: both of one vertex, and of the vertex furthest from
/// it the one across the line between them. A rigid motion costs nothing, so holding it takes
/// nothing from the step; left free, its curvature away from the minimum may be negative. Where the
/// scale is free as well, the fourth holds it. Of a region with one pin the first vertex is the
/// pinned one; a region with more is held by them.
void OptimalitySystem::hold_in_place(const Eigen::VectorXd& x, double stiffness) {
    for (std::size_t r = 0; r < domain_.regions.size(); ++r) {
        std::set<Index> pinned;
        for (const ConstraintRow& row : rows_) {
            if (row.terms.front().kind == TermKind::coordinate &&
                domain_.region_of(row.vertex) == r)
                pinned.insert(row.vertex);
        }
        if (pinned.size() > 1) continue;
        const Index base = pinned.empty() ? domain_.first[r] : *pinned.begin();
        Index far = base;
        double largest = -1.0;
        for (Index v = domain_.first[r]; v < domain_.first[r + 1]; ++v) {
            const double distance = (x.segment<2>(2 * v) - x.segment<2>(2 * base)).squaredNorm();
            if (distance <= largest) continue;
            largest = distance;
            far = v;
        }
        const Vec2 between = (x.segment<2>(2 * far) - x.segment<2>(2 * base)).cwiseAbs();
        const Index across = between.x() > between.y() ? 1 : 0;
        if (pinned.empty()) {
            diagonal(2 * base) += stiffness;
            diagonal(2 * base + 1) += stiffness;
        }
        diagonal(2 * far + across) += stiffness;
        if (distortion_.scale_free()) diagonal(2 * far + 1 - across) += stiffness;
    }
}

double OptimalitySystem::fill(const Eigen::VectorXd& x, const Eigen::VectorXd& multipliers,
                              const std::vector<Held>& held, HessianKind kind) {
    std::fill_n(matrix_.valuePtr(), matrix_.nonZeros(), 0.0);
    distortion_.add_hessian(x, kind, matrix_);
    const auto add = [&](Index row, Index column, double value) { entry(row, column) += value; };
    if (contact_ != nullptr) contact_->for_hessian(x, kind, add);
    if (stiff_curves_ != nullptr) stiff_curves_->for_hessian(x, kind, add);
    double trace = 0.0;
    for (Index i = 0; i < unknowns_; ++i) trace += diagonal(i);
    const double mean = trace / unknowns_;
    hold_in_place(x, tolerance::pin * mean);
    regularisation_ = tolerance::multiplier_regularisation / mean;
    regularised_.clear();
    for (Index k = 0; k < static_cast<Index>(rows_.size()); ++k) {
        const Index row = unknowns_ + k;
        if (held[at(k)] == Held::not_held) {
            diagonal(row) = -1.0 / mean;
            continue;
        }
        for (const Term& term : rows_[at(k)].terms) add_term(row, term, x, multipliers[k], kind);
        const bool soft = compliance_[at(k)] > 0.0;
        diagonal(row) = soft ? -compliance_[at(k)] : -regularisation_;
        if (!soft) regularised_.push_back(row);
    }
    return mean;
}

void OptimalitySystem::shift_diagonal(double amount) {
    for (Index i = 0; i < unknowns_; ++i) diagonal(i) += amount;
}

bool OptimalitySystem::has_right_inertia() {
    return solver_.factor(matrix_, progress_, threads_) &&
           solver_.negative_pivots() == static_cast<Index>(rows_.size());
}

void OptimalitySystem::factor(const Eigen::VectorXd& x, const Eigen::VectorXd& multipliers,
                              const std::vector<Held>& held, HessianKind kind) {
    // A shift of the diagonal shortens the step but moves no minimum. An exact Hessian may need
    // much of it where a locked curve is about to buckle, a projected one only against round-off.
    static constexpr std::array exact_shifts{tolerance::rigid_motion, 1e-4, 1e-3, 1e-2, 1e-1};
    static constexpr std::array projected_shifts{tolerance::rigid_motion, 1e-7, 1e-5, 1e-3};
    const auto attempt = [&](HessianKind attempted, std::span<const double> shifts) {
        const double mean = fill(x, multipliers, held, attempted);
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

bool OptimalitySystem::factor_exact(const Eigen::VectorXd& x, const Eigen::VectorXd& multipliers,
                                    const std::vector<Held>& held) {
    prepare(x);
    const double mean = fill(x, multipliers, held, HessianKind::exact);
    shift_diagonal(tolerance::rigid_motion * mean);
    return solver_.factor(matrix_, progress_, threads_);
}

Eigen::VectorXd OptimalitySystem::solve(const Eigen::VectorXd& top,
                                        const Eigen::VectorXd& bottom) const {
    Eigen::VectorXd right(top.size() + bottom.size());
    right << top, bottom;
    Eigen::VectorXd solution = solver_.solve(right);
    // Refinement takes the multipliers' regularisation out again: one step as a rule, more where a
    // soft row says nearly the same as exact ones.
    constexpr int most_steps = 4;
    constexpr double enough = 1e-12;
    double before = std::numeric_limits<double>::infinity();
    for (int step = 0; step < most_steps; ++step) {
        Eigen::VectorXd rest = right - matrix_.selfadjointView<Eigen::Lower>() * solution;
        for (const Index row : regularised_) rest[row] -= regularisation_ * solution[row];
        const double norm = rest.norm();
        if (norm <= enough * right.norm() || norm > 0.5 * before) break;
        before = norm;
        solution += solver_.solve(rest);
    }
    return solution;
}

}  // namespace lastflat
