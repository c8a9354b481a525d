// Points, indices and sparse matrices: the words every stage shares. Lengths are mm, angles
// radians.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <algorithm>
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

/// For each of 0 .. count - 1, where it stands in the list; -1: nowhere.
inline std::vector<Index> inverse(const std::vector<Index>& list, std::size_t count) {
    std::vector<Index> index(count, -1);
    for (std::size_t i = 0; i < list.size(); ++i) index[at(list[i])] = static_cast<Index>(i);
    return index;
}

template <class Range, class Item>
[[nodiscard]] bool contains(const Range& range, const Item& item) {
    return std::find(std::begin(range), std::end(range), item) != std::end(range);
}

/// Triangles with their corners' positions.
struct Triangulation {
    Points3 positions;                ///< mm
    std::vector<Triangle> triangles;  ///< counter-clockwise seen from outside

    [[nodiscard]] const Vec3& position(Index vertex) const {
        return positions[static_cast<std::size_t>(vertex)];
    }
};

using SparseMatrix = Eigen::SparseMatrix<double>;

}  // namespace lastflat
