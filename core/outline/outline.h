// The line along which a piece is cut, and which curve each part of it is.
#pragma once

#include "core/parameterize/chart.h"

namespace lastflat {

/// Outline points first, first + 1, ..., last (around the end where last < first) are the curve.
struct OutlineSegment {
    std::string curve;
    Index first, last;
};

/// Not closed by a repeated point, mm. Begins where a named curve begins.
struct OutlineLoop {
    Points2 points;
    std::vector<OutlineSegment> segments;  ///< in the order of their first points
};

/// The outer loop, counter-clockwise, and the holes, clockwise.
struct Outline : OutlineLoop {
    std::vector<OutlineLoop> holes;
};

[[nodiscard]] Outline trace_outline(const Region& region, const Chart& chart);

}  // namespace lastflat
