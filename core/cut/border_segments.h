// Which stretches of a region's border are named curves.
#pragma once

#include <optional>
#include <string_view>

#include "core/cut/region.h"

namespace lastflat {

/// Border vertices first, first + 1, ..., last (as places in `region.border`, around its end where
/// last < first) are a run of the curve.
struct BorderSegment {
    std::string curve;
    Index first, last;
};

/// One segment for every run that follows the border, in the order of the runs.
[[nodiscard]] std::vector<BorderSegment> border_segments(const Region& region);

}  // namespace lastflat
