// The line from seat to toe point, and what stands in for it.
#pragma once

#include <optional>

#include "core/cut/region.h"

namespace lastflat {

struct BaseLine {
    Index seat, toe;  ///< region vertices
};

/// From the named curves, if the region has them.
[[nodiscard]] std::optional<BaseLine> named_base_line(const Region& region);

/// The longest principal axis of all regions together, towards their longer tail.
[[nodiscard]] Vec3 long_axis(const std::vector<Region>& regions);

}  // namespace lastflat
