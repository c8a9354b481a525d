// What stands out of a workshop's last, or was cut into it: pins, knobs, nails, drilled holes, saw
// cuts.
#pragma once

#include <vector>

#include "core/landmarks/bare_last.h"

namespace lastflat {

/// A border of a feature on the last: vertices, as the border of the hole runs that would be left.
using Rim = std::vector<Index>;

struct Feature {
    std::vector<Index> faces;  ///< ascending
    std::vector<Rim> rims;     ///< more than one: it runs through the last
};

/// What may be features of a closed surface, each with the faces that it would take away.
///
/// A last is hollow nowhere but gently; a feature has walls that meet the last, or each other, in a
/// hollow. Around a patch of such walls the least cut of the graph of faces is looked for, in which
/// it is cheap to part at any sharp edge: the rim of a hole, the foot of a nail.
class FeatureSearch {
public:
    /// The surface must outlive the search.
    explicit FeatureSearch(const SurfaceMesh& surface);

    [[nodiscard]] const std::vector<std::vector<Index>>& walls() const { return walls_; }

    /// The features that walls belong to, if they reach at most so far beyond them. Every rim is a
    /// simple loop; none if that cannot be.
    [[nodiscard]] std::vector<Feature> features_around(const std::vector<Index>& walls,
                                                       double beyond_mm) const;

private:
    const SurfaceMesh& surface_;
    std::vector<BareFace> faces_;
    std::vector<std::vector<Index>> walls_;
    double sharp_ = 0.0;  ///< radians
};

}  // namespace lastflat
