#include "core/numerics/elimination_order.h"

#include <Eigen/OrderingMethods>
#include <algorithm>

namespace lastflat {

EliminationOrder elimination_order(const SparseMatrix& pattern) {
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, Index> order;
    Eigen::AMDOrdering<Index>()(pattern, order);
    return {order.indices().data(), order.indices().data() + order.size()};
}

EliminationOrder elimination_order(const HalfEdges& half_edges) {
    const Index n = half_edges.vertex_count();
    SparseMatrix pattern(n, n);
    pattern.reserve(static_cast<Eigen::Index>(7) * n);
    for (Index v = 0; v < n; ++v) {
        auto column = half_edges.ring(v);
        column.push_back(v);
        std::sort(column.begin(), column.end());
        pattern.startVec(v);
        for (const Index w : column) pattern.insertBackByOuterInner(v, w) = 1.0;
    }
    pattern.finalize();
    return elimination_order(pattern);
}

}  // namespace lastflat
