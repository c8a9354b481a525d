// What is flattened in one go.
#pragma once

#include "core/cut/region.h"
#include "core/parameterize/chart.h"

namespace lastflat {

/// Regions whose charts depend on each other, their vertices numbered one region after the other.
/// The regions must outlive the domain. Coordinates are x0, y0, x1, y1, ... in that order.
struct Domain {
    std::vector<const Region*> regions;
    std::vector<Index> first{0};  ///< per region its first vertex, and one more for the end

    explicit Domain(const std::vector<const Region*>& parts);

    [[nodiscard]] Index vertices() const { return first.back(); }
    /// The region that a vertex is in, by its index in `regions`.
    [[nodiscard]] std::size_t region_of(Index vertex) const;
    [[nodiscard]] const Vec3& position(Index vertex) const;
    [[nodiscard]] double distance(Index a, Index b) const {
        return (position(a) - position(b)).norm();
    }

    [[nodiscard]] Eigen::VectorXd coordinates(const std::vector<Chart>& charts) const;
    [[nodiscard]] std::vector<Chart> charts(const Eigen::VectorXd& x) const;
};

/// Where a vertex lies.
inline Vec2 point(const Eigen::VectorXd& coordinates, Index vertex) {
    return coordinates.segment<2>(2 * vertex);
}

}  // namespace lastflat
