// The linear system of one constrained Newton step.
#pragma once

#include <set>

#include "core/numerics/multifrontal_ldlt.h"
#include "core/numerics/nested_dissection.h"
#include "core/optimize/active_set.h"
#include "core/optimize/problem.h"
#include "core/progress.h"

namespace lastflat {

/// Where a search stands: the points' coordinates and the rows' multipliers.
struct Iterate {
    Eigen::VectorXd x, multipliers;

    /// Where nothing is known of the multipliers: zero.
    [[nodiscard]] static Iterate at(const Eigen::VectorXd& x, const Problem& problem) {
        return {x, Eigen::VectorXd::Zero(static_cast<Eigen::Index>(problem.rows.size()))};
    }
};

/// [H A^T; A -C] [step; multipliers] = [-gradient; -residual], where H is the Hessian of the
/// Lagrangian, A the gradients of the rows and C their compliance. A row that is not held has a
/// multiplier of zero. One pattern for all steps; it, its elimination order and the last factor are
/// the whole of the system, which can be kept for as long as the problem's rows and terms are.
///
/// Paper: [vanderbei-1995] (quasi-definite systems), [nocedal-2006], chapter 18.
class OptimalitySystem {
public:
    /// Analyses the problem's pattern, once and then whenever something new is near at the
    /// iterate; fills the system there and factors it. An exact Hessian that is not positive
    /// definite along the rows is shifted until it is or, failing that, replaced by the projected
    /// one.
    /// Throws: Error{solver_failed} if no shift helps; Error{canceled}.
    void factor(const Problem& problem, const Iterate& iterate, const std::vector<Held>& held,
                HessianKind kind, const Progress& progress);

    /// The same with the exact Hessian, whatever the sign of its curvature. False if it is
    /// singular.
    [[nodiscard]] bool factor_exact(const Problem& problem, const Iterate& iterate,
                                    const std::vector<Held>& held, const Progress& progress);

    /// Solves for (step, multipliers) given both right-hand sides, up to a residual of this share
    /// of them.
    [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& top, const Eigen::VectorXd& bottom,
                                        double accuracy) const;

    /// Whether the last factor, wherever it was made, is one with these rows held.
    [[nodiscard]] bool is_factored_with(const std::vector<Held>& held) const {
        return is_factored_ && held_ == held;
    }

    /// What a rounding of the coordinates changes in the gradient, where it was filled last.
    [[nodiscard]] double gradient_round_off() const { return gradient_round_off_; }

private:
    using Slots = std::array<Index, 21>;  ///< of an element's lower triangle, row by row
    void prepare(const Problem& problem, const Eigen::VectorXd& x);
    /// The positions, flat, are for the elimination order.
    void analyse(const Problem& problem, const Points2& positions);
    void make_pattern(const VertexGraph& graph, const std::vector<Row>& rows);
    [[nodiscard]] std::vector<VertexPair> vertex_pairs(const Problem& problem) const;
    [[nodiscard]] static std::vector<UnknownBlock> elimination_blocks(const VertexGraph& graph,
                                                                      const std::vector<Row>& rows,
                                                                      const Points2& positions);
    /// Of the Hessian's diagonal. Of needles it has entries beyond all others: the median is the
    /// measure for a shift that shortens no step needlessly, the mean for one above their
    /// round-off.
    struct DiagonalSize {
        double median, mean;
    };
    DiagonalSize fill(const Problem& problem, const Iterate& iterate, const std::vector<Held>& held,
                      HessianKind kind);
    void add_terms(const Problem& problem, const Eigen::VectorXd& x, HessianKind kind);
    void add_row(Index unknown, const Row& row, const Eigen::VectorXd& x, double multiplier,
                 HessianKind kind);
    void hold_still(const Problem& problem, const Eigen::VectorXd& x, double stiffness);
    void shift_diagonal(const Iterate& iterate, double amount);
    void add_block(Index a, Index b, const Eigen::Matrix2d& block);
    [[nodiscard]] Slots slots_of(const Triangle& element) const;
    [[nodiscard]] Index slot(Index row, Index column) const;
    double& entry(Index row, Index column) { return matrix_.valuePtr()[slot(row, column)]; }
    double& diagonal(Index i) { return matrix_.valuePtr()[matrix_.outerIndexPtr()[i]]; }

    std::set<VertexPair> passing_;           ///< of elements that the pattern has room for
    std::vector<std::vector<Slots>> slots_;  ///< per term, of its elements that are always there
    SparseMatrix matrix_;                    ///< lower triangle
    double gradient_round_off_ = 0.0;
    double regularisation_ = 0.0;
    std::vector<Index> regularised_;  ///< unknowns that have it
    std::vector<Held> held_;          ///< what the matrix was filled for
    bool is_factored_ = false;
    std::size_t threads_ = 1;  ///< of the last factor's problem
    MultifrontalLdlt solver_;
};

}  // namespace lastflat
