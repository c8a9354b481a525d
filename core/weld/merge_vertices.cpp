#include "core/weld/merge_vertices.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>

#include "core/numerics/disjoint_sets.h"

namespace lastflat {

namespace {

Eigen::Index longest_extent(const Points3& positions) {
    Eigen::AlignedBox3d box;
    for (const Vec3& p : positions) box.extend(p);
    Eigen::Index axis = 0;
    box.sizes().maxCoeff(&axis);
    return axis;
}

}  // namespace

std::vector<Index> each_for_itself(std::size_t count) {
    std::vector<Index> ids(count);
    std::iota(ids.begin(), ids.end(), 0);
    return ids;
}

std::vector<Index> merge_vertices(const Points3& positions, double tolerance_mm) {
    // A sweep along the longest extent: only vertices within the tolerance along it are compared.
    const auto at = [&](Index i) -> const Vec3& { return positions[static_cast<std::size_t>(i)]; };
    const Eigen::Index x = longest_extent(positions);
    const Eigen::Index y = (x + 1) % 3, z = (x + 2) % 3;
    std::vector<Index> order = each_for_itself(positions.size());
    std::sort(order.begin(), order.end(), [&](Index i, Index j) {
        if (at(i)[x] != at(j)[x]) return at(i)[x] < at(j)[x];
        if (at(i)[y] != at(j)[y]) return at(i)[y] < at(j)[y];
        if (at(i)[z] != at(j)[z]) return at(i)[z] < at(j)[z];
        return i < j;
    });
    DisjointSets sets(positions.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        for (std::size_t j = i + 1; j < order.size(); ++j) {
            if (at(order[j])[x] - at(order[i])[x] > tolerance_mm) break;
            if (tolerance_mm == 0.0 && at(order[j]) != at(order[i])) break;  // sorted: none follows
            if ((at(order[j]) - at(order[i])).norm() <= tolerance_mm) sets.join(order[i], order[j]);
        }
    }
    std::vector<Index> result(positions.size());
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = sets.find(static_cast<Index>(i));
    return result;
}

}  // namespace lastflat
