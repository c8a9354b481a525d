// What keeps locked curves smooth.
#pragma once

#include <array>

#include "core/constrain/constraint.h"
#include "core/parameterize/distortion.h"

namespace lastflat {

/// Gives curves whose every edge is locked the stiffness of a thin wire. A locked curve under
/// compression cannot become shorter, but it can fold up like a concertina where its edges are
/// short: on a fine mesh that would be the least distortion, and nothing to cut leather by. The
/// wire bends as the surface does for nothing; its stiffness is so small that only bends of a few
/// edges cost anything beside the surface: of the excess energy of a half of a last it is some
/// 1e-5.
///
/// Energy: k / 2 * sum of (turn - turn on the surface)^2 / length, mm^2, over the inner vertices.
class StiffCurves {
public:
    StiffCurves(const Domain& domain, const std::vector<Constraint>& constraints);

    /// Every two vertices that share a bend.
    [[nodiscard]] std::vector<std::pair<Index, Index>> vertex_pairs() const;

    [[nodiscard]] double value(const Eigen::VectorXd& x) const;
    void add_gradient(const Eigen::VectorXd& x, Eigen::VectorXd& gradient) const;

    /// Calls add(i, j, value) for every entry of the lower triangle, i and j coordinates. A
    /// projected Hessian is positive semi-definite.
    template <class Add>
    void for_hessian(const Eigen::VectorXd& x, HessianKind kind, const Add& add) const {
        for (const Bend& bend : bends_) {
            const auto hessian = bend_hessian(bend, x, kind);
            for (Index i = 0; i < 6; ++i) {
                for (Index j = 0; j < 6; ++j) {
                    const Index row = 2 * bend.vertices[static_cast<std::size_t>(i / 2)] + i % 2;
                    const Index column = 2 * bend.vertices[static_cast<std::size_t>(j / 2)] + j % 2;
                    if (row >= column) add(row, column, hessian(i, j));
                }
            }
        }
    }

private:
    using Matrix6 = Eigen::Matrix<double, 6, 6>;
    struct Bend {
        std::array<Index, 3> vertices;
        double turn;       ///< on the surface, radians, positive to the left
        double stiffness;  ///< over the length, mm^2
    };
    [[nodiscard]] static Matrix6 bend_hessian(const Bend& bend, const Eigen::VectorXd& x,
                                              HessianKind kind);
    void add_run(const Domain& domain, std::size_t region, const CurveRun& run);

    std::vector<Bend> bends_;
};

}  // namespace lastflat
