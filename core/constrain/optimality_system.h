// The linear system of one constrained Newton step.
#pragma once

#include <set>

#include "core/constrain/border_contact.h"
#include "core/constrain/constraint_rows.h"
#include "core/constrain/stiff_curves.h"
#include "core/numerics/multifrontal_ldlt.h"
#include "core/numerics/nested_dissection.h"
#include "core/parameterize/distortion.h"

namespace lastflat {

/// Which bound of a row holds it now. Equations are held by both.
enum class Held : signed char { by_least = -1, not_held = 0, by_most = 1 };

/// [H A^T; A -C] [step; multipliers] = [-gradient; -residual], where H is the Hessian of the
/// Lagrangian, A the gradients of the constraints and C what they give way (zero for all but soft
/// ones). A row that is not held has a multiplier of zero. One pattern for all steps.
///
/// Paper: [vanderbei-1995] (quasi-definite systems), [nocedal-2006], chapter 18.
class OptimalitySystem {
public:
    /// All arguments must outlive the system. `compliance`: per row how far, mm, it gives way to a
    /// force of 1 mm; 0: it does not. `contact` and `stiff_curves` may be null.
    /// `x`: where the vertices lie, about.
    OptimalitySystem(const Domain& domain, const std::vector<ConstraintRow>& rows,
                     const std::vector<double>& compliance, Distortion& distortion,
                     const BorderContact* contact, const StiffCurves* stiff_curves,
                     const Eigen::VectorXd& x, std::size_t threads, const Progress& progress);

    /// Makes room for contacts that are or may soon be near at x.
    void prepare(const Eigen::VectorXd& x);

    /// Fills and factors the system at x. An exact Hessian that is not positive definite along the
    /// constraints is shifted until it is or, failing that, replaced by the projected one.
    /// Throws: Error{solver_failed} if no shift helps; Error{cancelled}.
    void factor(const Eigen::VectorXd& x, const Eigen::VectorXd& multipliers,
                const std::vector<Held>& held, HessianKind kind);

    /// Fills and factors the system with the exact Hessian, whatever the sign of its curvature.
    /// False if it is singular.
    [[nodiscard]] bool factor_exact(const Eigen::VectorXd& x, const Eigen::VectorXd& multipliers,
                                    const std::vector<Held>& held);

    /// Solves for (step, multipliers) given both right-hand sides.
    [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& top,
                                        const Eigen::VectorXd& bottom) const;

    /// Adds A^T multipliers at x.
    void add_forces(const Eigen::VectorXd& x, const Eigen::VectorXd& multipliers,
                    Eigen::VectorXd& gradient) const;

private:
    using VertexPair = std::pair<Index, Index>;
    void analyse();
    [[nodiscard]] std::vector<VertexPair> vertex_pairs() const;
    [[nodiscard]] SparseMatrix pattern(const VertexGraph& graph) const;
    [[nodiscard]] std::vector<UnknownBlock> elimination_blocks(const VertexGraph& graph) const;
    /// Returns the mean of the Hessian's diagonal.
    double fill(const Eigen::VectorXd& x, const Eigen::VectorXd& multipliers,
                const std::vector<Held>& held, HessianKind kind);
    void hold_in_place(const Eigen::VectorXd& x, double stiffness);
    void shift_diagonal(double amount);
    [[nodiscard]] bool has_right_inertia();
    void add_term(Index row, const Term& term, const Eigen::VectorXd& x, double multiplier,
                  HessianKind kind);
    void add_block(Index a, Index b, const Eigen::Matrix2d& block);
    double& entry(Index row, Index column);
    double& diagonal(Index i) { return matrix_.valuePtr()[matrix_.outerIndexPtr()[i]]; }

    const Domain& domain_;
    const std::vector<ConstraintRow>& rows_;
    const std::vector<double>& compliance_;
    Distortion& distortion_;
    const BorderContact* contact_;
    const StiffCurves* stiff_curves_;
    std::set<VertexPair> contacts_;  ///< that the pattern has room for
    std::size_t threads_;
    const Progress& progress_;
    Index unknowns_;
    Points2 positions_;    ///< for the elimination order
    SparseMatrix matrix_;  ///< lower triangle
    double regularisation_ = 0.0;
    std::vector<Index> regularised_;  ///< rows that have it
    MultifrontalLdlt solver_;
};

}  // namespace lastflat
