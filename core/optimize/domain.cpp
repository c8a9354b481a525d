#include "core/optimize/domain.h"

#include <algorithm>

namespace lastflat {

Domain::Domain(const std::vector<const Region*>& parts) : regions(parts) {
    for (const Region* region : regions)
        first.push_back(first.back() + static_cast<Index>(region->positions.size()));
}

std::size_t Domain::region_of(Index vertex) const {
    return static_cast<std::size_t>(std::upper_bound(first.begin(), first.end(), vertex) -
                                    first.begin() - 1);
}

const Vec3& Domain::position(Index vertex) const {
    const std::size_t r = region_of(vertex);
    return regions[r]->position(vertex - first[r]);
}

Eigen::VectorXd Domain::coordinates(const std::vector<Chart>& charts) const {
    Eigen::VectorXd x(2 * vertices());
    Eigen::Index next = 0;
    for (const Chart& chart : charts) {
        for (const Vec2& p : chart.uv) {
            x.segment<2>(next) = p;
            next += 2;
        }
    }
    return x;
}

std::vector<Chart> Domain::charts(const Eigen::VectorXd& x) const {
    std::vector<Chart> result(regions.size());
    for (std::size_t r = 0; r < regions.size(); ++r) {
        for (Index v = first[r]; v < first[r + 1]; ++v)
            result[r].uv.emplace_back(x.segment<2>(2 * v));
    }
    return result;
}

}  // namespace lastflat
