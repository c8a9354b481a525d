// What keeps curves of fixed length smooth.
#pragma once

#include "core/optimize/domain.h"
#include "core/optimize/energy_term.h"

namespace lastflat {

/// A path of a region's vertices that is stiff.
struct Wire {
    std::size_t region;           ///< by its index in the domain
    std::vector<Index> vertices;  ///< of the region; consecutive ones share an edge
};

/// Gives curves whose every edge keeps its length the stiffness of a thin wire. Such a curve cannot
/// become shorter under compression, but it can fold up like a concertina where its edges are
/// short: on a fine mesh that would be the least distortion, and nothing to cut by. The wire bends
/// as the surface does for nothing; its stiffness is so small that only bends of a few edges cost
/// anything beside the surface: of the excess energy of a half of a last it is some 1e-5.
///
/// Energy: k / 2 * sum of (turn - turn on the surface)^2 / length, mm^2, over the inner vertices.
class WireStiffness final : public EnergyTerm {
public:
    WireStiffness(const Domain& domain, const std::vector<Wire>& wires);

    [[nodiscard]] double value(const Eigen::VectorXd& x) const override;
    void add_gradient(const Eigen::VectorXd& x, Eigen::VectorXd& gradient) const override;
    [[nodiscard]] std::vector<Triangle> elements() const override;
    void for_hessian(const Eigen::VectorXd& x, HessianKind kind,
                     const TakeHessian& take) const override;

private:
    struct Bend {
        Triangle vertices;  ///< in the order of the path
        double turn;        ///< on the surface, radians, positive to the left
        double stiffness;   ///< over the length, mm^2
    };
    [[nodiscard]] static Matrix6 bend_hessian(const Bend& bend, const Eigen::VectorXd& x,
                                              HessianKind kind);

    std::vector<Bend> bends_;
};

}  // namespace lastflat
