// Where distortion matters more, and of which sign.
#pragma once

#include <string>
#include <vector>

#include "core/cut/region.h"

namespace lastflat {

/// A part of the surface: what lies within a distance of a curve or of a vertex, or the triangles
/// all of whose corners are listed. One of the three.
struct Zone {
    std::string curve{};
    Index vertex = -1;              ///< id of the file
    std::vector<Index> vertices{};  ///< ids of the file
    double within_mm = 0.0;         ///< in a straight line, to the middle of a triangle
    double weight = 1.0;            ///< distortion here counts so much
};

struct DistortionWeights {
    std::vector<Zone> zones{};
    /// Of the leather when it is lasted: it stretches where the pattern is smaller than the last,
    /// and is compressed where it is larger.
    double stretch = 1.0, compression = 1.0;

    [[nodiscard]] bool even() const { return stretch == 1.0 && compression == 1.0; }
};

/// Per triangle the product of the weights of the zones that it is in, 0.001 to 1000.
[[nodiscard]] std::vector<double> triangle_weights(const Region& region,
                                                   const std::vector<Zone>& zones);

}  // namespace lastflat
