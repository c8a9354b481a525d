// What every part of an energy can say of itself.
#pragma once

#include <functional>
#include <limits>

#include "core/numerics/types.h"

namespace lastflat {

/// The energy where the points must never be.
inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// How Hessians of single elements enter the sum.
enum class HessianKind {
    projected,  ///< clamped to be positive semi-definite: always a direction of descent
    exact,      ///< as they are: quadratic convergence near a minimum
};

using VertexPair = std::pair<Index, Index>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Takes the Hessian of one element, by the six coordinates of its three vertices; the lower
/// triangle is meant.
using TakeHessian = std::function<void(const Triangle& element, const Matrix6& hessian)>;

/// Takes an element with its vertices in ascending order.
void take_ascending(const Triangle& element, const Matrix6& hessian, const TakeHessian& take);

/// One of the energies that add up, mm^2, as a function of the points' coordinates (see `Domain`).
class EnergyTerm {
public:
    virtual ~EnergyTerm() = default;

    /// Infinite where the points must never be.
    [[nodiscard]] virtual double value(const Eigen::VectorXd& x) const = 0;

    virtual void add_gradient(const Eigen::VectorXd& x, Eigen::VectorXd& gradient) const = 0;

    /// The triples of vertices that the Hessian couples wherever the points lie.
    [[nodiscard]] virtual std::vector<Triangle> elements() const { return {}; }

    /// Pairs of vertices without a common edge that it couples at x besides or, for a `reach` above
    /// 1, might soon: of what acts when it is near, all that is nearer than so many times the
    /// distance at which it begins to.
    [[nodiscard]] virtual std::vector<VertexPair> passing_pairs(const Eigen::VectorXd& /*x*/,
                                                                double /*reach*/) const {
        return {};
    }

    /// The Hessian, element by element: first `elements()`, in their order, then what passes at x.
    virtual void for_hessian(const Eigen::VectorXd& x, HessianKind kind,
                             const TakeHessian& take) const = 0;

    /// The largest share, at most 1, of the step d from x that it lets pass.
    [[nodiscard]] virtual double largest_step(const Eigen::VectorXd& /*x*/,
                                              const Eigen::VectorXd& /*d*/) const {
        return 1.0;
    }
};

}  // namespace lastflat
