// Borders that must not cross themselves.
#pragma once

#include "core/optimize/domain.h"
#include "core/optimize/energy_term.h"

namespace lastflat {

/// A border vertex near an edge of the same border loop: vertices of the domain.
struct ContactPair {
    Index point, a, b;
    double clearance;  ///< mm, see `BorderContact`
};

/// Keeps every border loop from crossing itself. That is enough: how often a map without flips
/// covers a point is the sum of the loops' winding numbers around it. A simple outer loop winds
/// around its inside once, and a simple hole once the other way, as it did at the start, since to
/// turn round it would have to cross itself. So no point is covered twice, and no loop meets
/// another. Border vertices that come nearer to an edge of their loop than the pair's clearance are
/// pushed away by a pressure that grows without bound, and no step goes through an edge. What stays
/// apart feels nothing: the clearance is a hundredth of the mean border edge, but never more than a
/// quarter of the way between both along the border, nor than half their distance on the surface
/// unless they are the two sides of a slit.
///
/// Paper: [smith-2015], section 3.3 (barrier, step to the first collision); the barrier's form and
///        the lists of near pairs: [li-2020], sections 3 and 4.
class BorderContact final : public EnergyTerm {
public:
    /// The domain must outlive the contact.
    explicit BorderContact(const Domain& domain);

    /// The greatest clearance of a pair, mm.
    [[nodiscard]] double clearance() const { return clearance_; }

    /// Pairs nearer than this multiple of their clearance.
    [[nodiscard]] std::vector<ContactPair> near_pairs(const Eigen::VectorXd& x,
                                                      double multiple = 1.0) const;

    /// The barrier: zero if nothing is near, infinite if a border meets itself.
    [[nodiscard]] double value(const Eigen::VectorXd& x) const override;
    void add_gradient(const Eigen::VectorXd& x, Eigen::VectorXd& gradient) const override;
    [[nodiscard]] std::vector<VertexPair> passing_pairs(const Eigen::VectorXd& x,
                                                        double reach) const override;
    void for_hessian(const Eigen::VectorXd& x, HessianKind kind,
                     const TakeHessian& take) const override;

    /// Ends before a border vertex meets an edge on the way.
    [[nodiscard]] double largest_step(const Eigen::VectorXd& x,
                                      const Eigen::VectorXd& d) const override;

private:
    struct Loop {
        std::vector<Index> vertices;  ///< of the domain; edge i runs from i to its successor
        std::vector<double> along;    ///< per vertex, the way from the first, and one for the end
        std::vector<double> lengths;  ///< per vertex, half of its two edges on the surface
    };
    [[nodiscard]] double clearance_of(const Loop& loop, std::size_t vertex, std::size_t edge) const;
    [[nodiscard]] bool crosses(const Eigen::VectorXd& x) const;
    [[nodiscard]] double first_meeting(const Eigen::VectorXd& x, const Eigen::VectorXd& d,
                                       double part) const;
    [[nodiscard]] Matrix6 pair_hessian(const ContactPair& pair, const Eigen::VectorXd& x,
                                       HessianKind kind) const;
    template <class Visit>
    void for_candidates(const Eigen::VectorXd& x, const Eigen::VectorXd& to, double distance,
                        const Visit& visit) const;

    const Domain& domain_;
    std::vector<Loop> loops_;
    std::vector<double> weight_;  ///< per vertex of the domain, mm^2; zero inside
    double clearance_ = 0.0;
};

}  // namespace lastflat
