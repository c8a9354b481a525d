// Based on: Sederberg, Gao, Wang, Mu, "2-D Shape Blending: An Intrinsic Solution to the Vertex Path
// Problem", SIGGRAPH 1993.
#include "core/border/tweak_edges.h"

#include <Eigen/LU>
#include <cmath>

#include "core/error.h"
#include "core/numerics/tolerances.h"
#include "core/text.h"

namespace lastflat {

Points2 tweak_edges(const std::vector<double>& lengths, const std::vector<double>& turning,
                    const std::vector<bool>& locked,
                    const std::function<std::string(std::size_t)>& name_edge) {
    std::vector<Vec2> d(lengths.size());
    double alpha = 0.0;
    for (std::size_t i = 0; i < d.size(); ++i) {
        if (i > 0) alpha += turning[i];
        d[i] = {std::cos(alpha), std::sin(alpha)};
    }
    Vec2 c = Vec2::Zero();
    Eigen::Matrix2d M = Eigen::Matrix2d::Zero();
    for (std::size_t i = 0; i < d.size(); ++i) {
        c += lengths[i] * d[i];
        if (!locked[i]) M += lengths[i] * lengths[i] * d[i] * d[i].transpose();
    }
    // The bound of the determinant is (trace / 2)^2.
    if (!(M.determinant() > tolerance::parallel * 0.25 * M.trace() * M.trace())) {
        throw Error(ErrorCode::method_failed,
                    "the border cannot be closed: all its edges are locked, or all free ones are "
                    "parallel; unlock " +
                        name_edge(0));
    }
    const Vec2 multiplier = M.inverse() * c;
    Points2 points{Vec2::Zero()};
    for (std::size_t i = 0; i < d.size(); ++i) {
        const double s = locked[i] ? 0.0 : -lengths[i] * lengths[i] * d[i].dot(multiplier);
        const double length = lengths[i] + s;
        if (!(length > 0.0)) {
            throw Error(ErrorCode::method_failed, "closing the border would take an edge from " +
                                                      general_text(lengths[i], 3) + " mm to " +
                                                      general_text(length, 3) + " mm, on " +
                                                      name_edge(i));
        }
        if (i + 1 < d.size()) points.push_back(points.back() + length * d[i]);
    }
    return points;
}

}  // namespace lastflat
