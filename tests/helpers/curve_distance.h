// How far one line is from another.
#pragma once

#include <algorithm>
#include <limits>

#include "core/numerics/types.h"

namespace lastflat::test {

struct LineDistance {
    double mean = 0.0, most = 0.0;
};

/// Of the corners of `line` from `other`.
inline LineDistance distance_between(const Points3& line, const Points3& other) {
    LineDistance result;
    for (const Vec3& p : line) {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 1; i < other.size(); ++i) {
            const Vec3 along = other[i] - other[i - 1];
            const double square = along.squaredNorm();
            const double share =
                square > 0.0 ? std::clamp(along.dot(p - other[i - 1]) / square, 0.0, 1.0) : 0.0;
            least = std::min(least, (other[i - 1] + share * along - p).norm());
        }
        result.mean += least / static_cast<double>(line.size());
        result.most = std::max(result.most, least);
    }
    return result;
}

}  // namespace lastflat::test
