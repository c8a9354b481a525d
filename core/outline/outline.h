// The line along which a piece is cut, and which curve each part of it is.
#pragma once

#include "core/parameterize/chart.h"

namespace lastflat {

/// Outline points first, first + 1, ..., last (around the end where last < first) are the curve.
struct OutlineSegment {
    std::string curve;
    Index first, last;
};

/// Counter-clockwise, not closed by a repeated point, mm. Begins where a named curve begins.
struct Outline {
    Points2 points;
    std::vector<OutlineSegment> segments;  ///< in the order of their first points
};

[[nodiscard]] Outline trace_outline(const Region& region, const Chart& chart);

}  // namespace lastflat
