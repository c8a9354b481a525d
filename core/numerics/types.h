// Points, indices and sparse matrices: the words every stage shares. Lengths are mm, angles
// radians.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <cstdint>
#include <vector>

namespace lastflat {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Points2 = std::vector<Vec2>;
using Points3 = std::vector<Vec3>;

using Index = std::int32_t;
using Triangle = std::array<Index, 3>;

/// As an index of a standard container.
inline std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}

/// Triangles with their corners' places.
struct Triangulation {
    Points3 positions;                ///< mm
    std::vector<Triangle> triangles;  ///< counter-clockwise seen from outside

    [[nodiscard]] const Vec3& position(Index vertex) const {
        return positions[static_cast<std::size_t>(vertex)];
    }
};

using SparseMatrix = Eigen::SparseMatrix<double>;

}  // namespace lastflat
