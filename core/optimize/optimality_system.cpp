// Based on: Vanderbei, "Symmetric Quasidefinite Matrices", SIAM J. Optimization 1995; Nocedal,
// Wright, "Numerical Optimization", 2006, chapter 18.
#include "core/optimize/optimality_system.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "core/error.h"
#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

/// Positions of the vertices for the dissection: flat, where a plane cuts a folded surface but
/// once; the regions far from each other, so that the first planes run between them.
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

/// Makes room for what passes at x, or soon may. What passed before keeps its room, so that not
/// every step needs a new analysis, until most of it has gone by.
void OptimalitySystem::prepare(const Problem& problem, const Eigen::VectorXd& x) {
    constexpr double now = 1.0, soon = 3.0;
    constexpr std::size_t most_gone_by = 2;  // per pair that passes
    const auto passing = [&](double reach) {
        std::set<VertexPair> pairs;
        for (const EnergyTerm* term : problem.terms) {
            for (const auto& [a, b] : term->passing_pairs(x, reach))
                pairs.insert(std::minmax(a, b));
        }
        return pairs;
    };
    const std::set<VertexPair> here = passing(now);
    const bool is_analysed = matrix_.size() > 0;
    if (is_analysed && std::includes(passing_.begin(), passing_.end(), here.begin(), here.end()))
        return;
    std::set<VertexPair> near = passing(soon);
    if (passing_.size() > most_gone_by * near.size()) passing_.clear();
    passing_.merge(near);
    analyse(problem, spread_positions(problem.domain, x));
}

void OptimalitySystem::analyse(const Problem& problem, const Points2& positions) {
    const VertexGraph graph = vertex_graph(problem.domain.vertices(), vertex_pairs(problem));
    make_pattern(graph, problem.rows);
    slots_.clear();
    for (const EnergyTerm* term : problem.energy()) {
        slots_.emplace_back();
        for (const Triangle& element : term->elements()) slots_.back().push_back(slots_of(element));
    }
    solver_.analyse(matrix_, elimination_blocks(graph, problem.rows, positions));
}

/// Every two vertices that share an element or a row's term, the smaller first; with repeats.
std::vector<VertexPair> OptimalitySystem::vertex_pairs(const Problem& problem) const {
    std::vector<VertexPair> pairs(passing_.begin(), passing_.end());
    for (const EnergyTerm* term : problem.energy()) {
        for (const Triangle& t : term->elements()) {
            for (std::size_t i = 0; i < 3; ++i) pairs.push_back(std::minmax(t[i], t[(i + 1) % 3]));
        }
    }
    for (const Row& row : problem.rows) {
        for (const RowTerm& term : row.terms) {
            std::visit(
                [&](const auto& of) {
                    const auto vertices = of.vertices();
                    for (std::size_t i = 1; i < vertices.size(); ++i)
                        pairs.push_back(std::minmax(vertices[i - 1], vertices[i]));
                },
                term.of);
        }
    }
    return pairs;
}

/// The lower triangle's pattern, all values zero: a 2x2 block for every edge of the graph and every
/// vertex, a row for every constraint.
void OptimalitySystem::make_pattern(const VertexGraph& graph, const std::vector<Row>& rows) {
    const Index n = graph.size();
    const auto m = static_cast<Index>(rows.size());
    std::vector<std::vector<Index>> rows_at(at(n));
    for (Index k = 0; k < m; ++k) {
        for (const Index v : rows[at(k)].vertices()) rows_at[at(v)].push_back(2 * n + k);
    }
    matrix_ = SparseMatrix(2 * n + m, 2 * n + m);
    matrix_.reserve(static_cast<Eigen::Index>(2 * graph.neighbours.size()) + 4 * n + 8 * m);
    for (Index v = 0; v < n; ++v) {
        for (Index side = 0; side < 2; ++side) {
            const Index column = 2 * v + side;
            matrix_.startVec(column);
            for (Index i = side; i < 2; ++i)
                matrix_.insertBackByOuterInner(column, 2 * v + i) = 0.0;
            for (Index e = graph.begin[at(v)]; e < graph.begin[at(v) + 1]; ++e) {
                const Index w = graph.neighbours[at(e)];
                if (w < v) continue;
                for (Index i = 0; i < 2; ++i)
                    matrix_.insertBackByOuterInner(column, 2 * w + i) = 0.0;
            }
            for (const Index row : rows_at[at(v)])
                matrix_.insertBackByOuterInner(column, row) = 0.0;
        }
    }
    for (Index k = 0; k < m; ++k) {
        matrix_.startVec(2 * n + k);
        matrix_.insertBackByOuterInner(2 * n + k, 2 * n + k) = 0.0;
    }
    matrix_.finalize();
}

/// Both coordinates of the dissection's vertices. A multiplier comes after all vertices of its
/// row, in the block where the last of them are: before them its pivot would be next to nothing.
std::vector<UnknownBlock> OptimalitySystem::elimination_blocks(const VertexGraph& graph,
                                                               const std::vector<Row>& rows,
                                                               const Points2& positions) {
    const auto dissection = nested_dissection(graph, positions);
    std::vector<UnknownBlock> blocks(dissection.size());
    std::vector<Index> block_of(at(graph.size()));
    for (std::size_t b = 0; b < dissection.size(); ++b) {
        blocks[b].parent = dissection[b].parent;
        for (const Index v : dissection[b].vertices) {
            block_of[at(v)] = static_cast<Index>(b);
            for (const Index i : {2 * v, 2 * v + 1}) blocks[b].unknowns.push_back(i);
        }
    }
    std::vector<Index> across;  // rows whose vertices have no block in common
    for (Index k = 0; k < static_cast<Index>(rows.size()); ++k) {
        const auto vertices = rows[at(k)].vertices();
        Index block = block_of[at(vertices.front())];
        for (const Index v : vertices) {
            if (block >= 0) block = common_block(blocks, block, block_of[at(v)], -1);
        }
        (block < 0 ? across : blocks[at(block)].unknowns).push_back(2 * graph.size() + k);
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

Index OptimalitySystem::slot(Index row, Index column) const {
    const auto* begin = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[column];
    const auto* end = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[column + 1];
    return static_cast<Index>(std::lower_bound(begin, end, row) - matrix_.innerIndexPtr());
}

OptimalitySystem::Slots OptimalitySystem::slots_of(const Triangle& element) const {
    // Of the block of two vertices the upper left entry is looked for. Below it stands the next one
    // of its column; the second column has the same rows but the first of the diagonal block.
    std::array<std::array<Index, 3>, 3> first{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            const auto [low, high] = std::minmax(element[i], element[j]);
            first[i][j] = slot(2 * high, 2 * low);
        }
    }
    Slots slots{};
    std::size_t next = 0;
    for (std::size_t i = 0; i < 6; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            const auto [low, high] = std::minmax(element[i / 2], element[j / 2]);
            const bool swapped = element[i / 2] < element[j / 2];
            Index row = static_cast<Index>(i % 2), column = static_cast<Index>(j % 2);
            if (swapped) std::swap(row, column);
            const Index begin = matrix_.outerIndexPtr()[2 * low];
            const Index second = matrix_.outerIndexPtr()[2 * low + 1];
            const Index upper_left = first[i / 2][j / 2];
            slots[next++] = column == 0 ? upper_left + row : upper_left - begin + second - 1 + row;
        }
    }
    return slots;
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

void OptimalitySystem::add_terms(const Problem& problem, const Eigen::VectorXd& x,
                                 HessianKind kind) {
    const auto add = [values = matrix_.valuePtr()](const Matrix6& hessian, const Slots& slots) {
        std::size_t slot = 0;
        for (Eigen::Index i = 0; i < 6; ++i) {
            for (Eigen::Index j = 0; j <= i; ++j) values[slots[slot++]] += hessian(i, j);
        }
    };
    auto known = slots_.begin();
    for (const EnergyTerm* term : problem.energy()) {
        term->for_hessian(x, kind,
                          [&, next = known->begin(), end = known->end()](
                              const Triangle& element, const Matrix6& hessian) mutable {
                              add(hessian, next < end ? *next++ : slots_of(element));
                          });
        ++known;
    }
}

void OptimalitySystem::add_row(Index unknown, const Row& row, const Eigen::VectorXd& x,
                               double multiplier, HessianKind kind) {
    row.for_gradient(x, [&](Index vertex, double factor, const Vec2& gradient) {
        for (Index i = 0; i < 2; ++i) entry(unknown, 2 * vertex + i) += factor * gradient[i];
    });
    row.for_hessian(x, multiplier, kind, [&](Index a, Index b, const Eigen::Matrix2d& block) {
        add_block(a, b, block);
    });
}

/// Stiffens three coordinates of every region: both of one vertex, and of the vertex furthest from
/// it the one across the line between them. A rigid motion costs nothing, so holding it takes
/// nothing from the step; left free, its curvature away from the minimum may be negative. Where the
/// scale is free as well, the fourth holds it. Of a region with one pin the first vertex is the
/// pinned one; a region with more is held by them.
void OptimalitySystem::hold_still(const Problem& problem, const Eigen::VectorXd& x,
                                  double stiffness) {
    const Domain& domain = problem.domain;
    for (std::size_t r = 0; r < domain.regions.size(); ++r) {
        std::set<Index> pinned;
        for (const Row& row : problem.rows) {
            if (row.coordinate() != nullptr && domain.region_of(row.vertex) == r)
                pinned.insert(row.vertex);
        }
        if (pinned.size() > 1) continue;
        const Index base = pinned.empty() ? domain.first[r] : *pinned.begin();
        Index far = base;
        double largest = -1.0;
        for (Index v = domain.first[r]; v < domain.first[r + 1]; ++v) {
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
        if (problem.distortion.scale_free()) diagonal(2 * far + 1 - across) += stiffness;
    }
}

OptimalitySystem::DiagonalSize OptimalitySystem::fill(const Problem& problem,
                                                      const Iterate& iterate,
                                                      const std::vector<Held>& held,
                                                      HessianKind kind) {
    is_factored_ = false;
    held_ = held;
    std::fill_n(matrix_.valuePtr(), matrix_.nonZeros(), 0.0);
    add_terms(problem, iterate.x, kind);
    const auto unknowns = static_cast<Index>(iterate.x.size());
    double trace = 0.0, round_off = 0.0;
    std::vector<double> entries;
    for (Index i = 0; i < unknowns; ++i) {
        trace += diagonal(i);
        entries.push_back(std::abs(diagonal(i)));
        round_off += std::pow(diagonal(i) * iterate.x[i], 2);
    }
    gradient_round_off_ = std::numeric_limits<double>::epsilon() * std::sqrt(round_off);
    const double mean = trace / unknowns;
    const auto middle = entries.begin() + unknowns / 2;
    std::nth_element(entries.begin(), middle, entries.end());
    hold_still(problem, iterate.x, tolerance::pin * mean);
    regularisation_ = tolerance::multiplier_regularisation / mean;
    regularised_.clear();
    for (std::size_t k = 0; k < problem.rows.size(); ++k) {
        const Row& row = problem.rows[k];
        const Index unknown = unknowns + static_cast<Index>(k);
        if (held[k] == Held::not_held) {
            diagonal(unknown) = -1.0 / mean;
            continue;
        }
        add_row(unknown, row, iterate.x, iterate.multipliers[static_cast<Eigen::Index>(k)], kind);
        diagonal(unknown) = row.is_soft() ? -row.compliance : -regularisation_;
        if (!row.is_soft()) regularised_.push_back(unknown);
    }
    return {*middle, mean};
}

void OptimalitySystem::shift_diagonal(const Iterate& iterate, double amount) {
    for (Index i = 0; i < static_cast<Index>(iterate.x.size()); ++i) diagonal(i) += amount;
}

void OptimalitySystem::factor(const Problem& problem, const Iterate& iterate,
                              const std::vector<Held>& held, HessianKind kind,
                              const Progress& progress) {
    // A shift of the diagonal shortens the step but moves no minimum. An exact Hessian may need
    // much of it where a locked curve is about to buckle, a projected one only against round-off.
    static constexpr std::array exact_shifts{tolerance::rigid_motion, 1e-4, 1e-3, 1e-2, 1e-1};
    static constexpr std::array projected_shifts{tolerance::rigid_motion, 1e-7, 1e-5, 1e-3};
    prepare(problem, iterate.x);
    threads_ = problem.threads;
    const auto attempt = [&](HessianKind attempted, std::span<const double> shifts,
                             double DiagonalSize::*measure) {
        const double typical = fill(problem, iterate, held, attempted).*measure;
        double shifted = 0.0;
        for (const double shift : shifts) {
            shift_diagonal(iterate, (shift - shifted) * typical);
            shifted = shift;
            if (solver_.factor(matrix_, progress, problem.threads) &&
                solver_.negative_pivots() == static_cast<Index>(problem.rows.size()))
                return is_factored_ = true;
        }
        return false;
    };
    if (kind == HessianKind::exact &&
        attempt(HessianKind::exact, exact_shifts, &DiagonalSize::median))
        return;
    if (attempt(HessianKind::projected, projected_shifts, &DiagonalSize::median)) return;
    if (attempt(HessianKind::projected, projected_shifts, &DiagonalSize::mean)) return;
    throw Error(ErrorCode::solver_failed, "a Newton step could not be computed");
}

bool OptimalitySystem::factor_exact(const Problem& problem, const Iterate& iterate,
                                    const std::vector<Held>& held, const Progress& progress) {
    prepare(problem, iterate.x);
    threads_ = problem.threads;
    const double typical = fill(problem, iterate, held, HessianKind::exact).median;
    shift_diagonal(iterate, tolerance::rigid_motion * typical);
    return is_factored_ = solver_.factor(matrix_, progress, problem.threads);
}

Eigen::VectorXd OptimalitySystem::solve(const Eigen::VectorXd& top, const Eigen::VectorXd& bottom,
                                        double accuracy) const {
    Eigen::VectorXd right(top.size() + bottom.size());
    right << top, bottom;
    Eigen::VectorXd solution = solver_.solve(right, threads_);
    // Refinement takes the multipliers' regularisation out again: one step as a rule, more where a
    // soft row says nearly the same as exact ones.
    constexpr int most_steps = 4;
    double before = infinity;
    for (int step = 0; step < most_steps; ++step) {
        Eigen::VectorXd rest = right - matrix_.selfadjointView<Eigen::Lower>() * solution;
        for (const Index row : regularised_) rest[row] -= regularisation_ * solution[row];
        const double norm = rest.norm();
        if (norm <= accuracy * right.norm() || norm > 0.5 * before) break;
        before = norm;
        solution += solver_.solve(rest, threads_);
    }
    return solution;
}

}  // namespace lastflat
