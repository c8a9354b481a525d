// Points and lines from the last to its pattern and back.
#pragma once

#include "api/map.h"
#include "core/map/pattern_map.h"

namespace lastflat::server {

/// Lines come back with points a millimetre apart.
/// Throws: Error.
[[nodiscard]] api::Mapped mapped(PatternMap& map, const api::MapRequest& request);

}  // namespace lastflat::server
