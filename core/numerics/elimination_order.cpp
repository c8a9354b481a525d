#include "core/numerics/elimination_order.h"

#include <Eigen/OrderingMethods>

namespace lastflat {

EliminationOrder elimination_order(const SparseMatrix& pattern) {
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, Index> order;
    Eigen::AMDOrdering<Index>()(pattern, order);
    return {order.indices().data(), order.indices().data() + order.size()};
}

}  // namespace lastflat
