// Borders that must not cross themselves.
#pragma once

#include "core/parameterize/distortion.h"

namespace lastflat {

/// A border vertex near a border edge of the same region: vertices of the domain.
struct ContactPair {
    Index point, a, b;
};

/// Keeps the border of every region from crossing itself: border vertices that come nearer to a
/// border edge than `clearance` are pushed away by a pressure that grows without bound, and no step
/// goes through an edge. What stays apart feels nothing.
///
/// Paper: [smith-2015], section 3.3 (barrier, step to the first collision); the barrier's form and
///        the lists of near pairs: [li-2020], sections 3 and 4.
class BorderContact {
public:
    explicit BorderContact(const Domain& domain);

    /// mm, a hundredth of the mean border edge.
    [[nodiscard]] double clearance() const { return clearance_; }

    /// Vertex and edge pairs nearer than `distance`, ascending.
    [[nodiscard]] std::vector<ContactPair> near_pairs(const Eigen::VectorXd& x,
                                                      double distance) const;

    /// The barrier, mm^2: zero if nothing is near, infinite if a vertex lies on an edge.
    [[nodiscard]] double value(const Eigen::VectorXd& x) const;

    void add_gradient(const Eigen::VectorXd& x, Eigen::VectorXd& gradient) const;

    /// Calls add(i, j, value) for every entry of the lower triangle, i and j coordinates.
    template <class Add>
    void for_hessian(const Eigen::VectorXd& x, HessianKind kind, const Add& add) const {
        for (const ContactPair& pair : near_pairs(x, clearance_)) {
            const std::array<Index, 3> vertices{pair.a, pair.b, pair.point};
            const auto hessian = pair_hessian(pair, x, kind);
            for (Index i = 0; i < 6; ++i) {
                for (Index j = 0; j < 6; ++j) {
                    const Index row = 2 * vertices[static_cast<std::size_t>(i / 2)] + i % 2;
                    const Index column = 2 * vertices[static_cast<std::size_t>(j / 2)] + j % 2;
                    if (row >= column) add(row, column, hessian(i, j));
                }
            }
        }
    }

    /// Largest step t <= 1 for which no border vertex on the way from x to x + t d meets an edge.
    [[nodiscard]] double collision_step(const Eigen::VectorXd& x, const Eigen::VectorXd& d) const;

private:
    using Matrix6 = Eigen::Matrix<double, 6, 6>;
    struct Loop {
        std::vector<Index> vertices;  ///< of the domain; edge i runs from i to its successor
        std::vector<double> lengths;  ///< per vertex, half of its two edges on the surface
    };
    [[nodiscard]] Matrix6 pair_hessian(const ContactPair& pair, const Eigen::VectorXd& x,
                                       HessianKind kind) const;
    template <class Visit>
    void for_candidates(const Eigen::VectorXd& x, const Eigen::VectorXd& to, double distance,
                        const Visit& visit) const;

    std::vector<Loop> loops_;
    std::vector<double> weight_;  ///< per vertex of the domain, mm^2; zero inside
    double clearance_ = 0.0;
};

}  // namespace lastflat
