// Which stretches of a region's border are named curves.
#pragma once

#include <optional>
#include <string_view>

#include "core/cut/region.h"

namespace lastflat {

/// Loop vertices first, first + 1, ..., last (as indices in the loop, around its end where
/// last < first) are a run of the curve. Of a curve that is the whole loop, first == last.
struct BorderSegment {
    std::string curve;
    Index first, last;
};

/// One segment for every run that follows the border loop, in the order of the runs.
[[nodiscard]] std::vector<BorderSegment> border_segments(const Region& region,
                                                         const std::vector<Index>& loop);

}  // namespace lastflat
