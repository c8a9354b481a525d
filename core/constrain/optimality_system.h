// The linear system of one constrained Newton step.
#pragma once

#include "core/constrain/length_constraints.h"
#include "core/numerics/sparse_solvers.h"
#include "core/parameterize/distortion.h"

namespace lastflat {

/// [H A^T; A 0] [step; multipliers] = [-gradient; -residual], where H is the Hessian of the
/// Lagrangian and A the gradients of the constraints. One pattern for all steps.
class OptimalitySystem {
public:
    OptimalitySystem(const Region& region, const std::vector<LengthConstraint>& constraints,
                     Distortion& distortion);

    /// Per constraint, flat length minus wanted length, mm.
    [[nodiscard]] Eigen::VectorXd residual(const Eigen::VectorXd& x) const;

    /// Fills and factors the system at x. An exact Hessian that is not positive definite along the
    /// constraints is shifted until it is or, failing that, replaced by the projected one.
    /// Throws: Error{solver_failed} if no shift helps.
    void factor(const Eigen::VectorXd& x, const Eigen::VectorXd& multipliers, HessianKind kind);

    /// The gradient of the distortion where the system was factored.
    [[nodiscard]] const Eigen::VectorXd& gradient() const { return gradient_; }

    /// Solves for (step, multipliers) given both right-hand sides.
    [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& top,
                                        const Eigen::VectorXd& bottom) const;

private:
    /// Returns the mean of the Hessian's diagonal.
    double fill(const Eigen::VectorXd& x, const Eigen::VectorXd& multipliers, HessianKind kind);
    void shift_diagonal(double amount);
    [[nodiscard]] bool has_right_inertia();
    void add_constraint(Index row, const Eigen::VectorXd& x, double multiplier, HessianKind kind);
    double& entry(Index row, Index column);

    const std::vector<LengthConstraint>& constraints_;
    Distortion& distortion_;
    Index unknowns_;
    SparseMatrix matrix_;  ///< lower triangle
    double regularisation_ = 0.0;
    Eigen::VectorXd gradient_;
    QuasiDefiniteSolver solver_;
};

}  // namespace lastflat
