// An old chart as the start of a region that was cut otherwise.
#pragma once

#include <optional>

#include "core/cut/region.h"
#include "core/parameterize/chart.h"

namespace lastflat {

/// The chart of a region that covers about the same surface as another: every vertex lies where the
/// old chart maps it; beyond the old border the nearest triangle's map goes on.
///
/// Out: nothing if the carried chart has a flipped triangle or crosses its own border.
[[nodiscard]] std::optional<Chart> carried_chart(const Region& old, const Chart& chart,
                                                 const Region& region);

}  // namespace lastflat
