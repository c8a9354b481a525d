#include "core/optimize/energy_term.h"

#include <algorithm>

namespace lastflat {

void take_ascending(const Triangle& element, const Matrix6& hessian, const TakeHessian& take) {
    std::array<Eigen::Index, 3> order{0, 1, 2};
    std::sort(order.begin(), order.end(), [&](Eigen::Index i, Eigen::Index j) {
        return element[static_cast<std::size_t>(i)] < element[static_cast<std::size_t>(j)];
    });
    Triangle ascending{};
    Matrix6 sorted;
    for (std::size_t i = 0; i < 3; ++i) {
        ascending[i] = element[static_cast<std::size_t>(order[i])];
        for (std::size_t j = 0; j < 3; ++j) {
            sorted.block<2, 2>(static_cast<Eigen::Index>(2 * i), static_cast<Eigen::Index>(2 * j)) =
                hessian.block<2, 2>(2 * order[i], 2 * order[j]);
        }
    }
    take(ascending, sorted);
}

}  // namespace lastflat
