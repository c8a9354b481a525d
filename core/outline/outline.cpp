#include "core/outline/outline.h"

#include <algorithm>

#include "core/cut/border_segments.h"

namespace lastflat {
namespace {

OutlineLoop trace_loop(const Region& region, const std::vector<Index>& border, const Chart& chart) {
    const auto n = static_cast<Index>(border.size());
    OutlineLoop loop;
    for (const BorderSegment& segment : border_segments(region, border)) {
        loop.segments.push_back({segment.curve, segment.first, segment.last});
    }
    const Index start = loop.segments.empty() ? 0 : loop.segments.front().first;
    for (Index i = 0; i < n; ++i) {
        const Index v = border[static_cast<std::size_t>((start + i) % n)];
        loop.points.push_back(chart.uv[static_cast<std::size_t>(v)]);
    }
    for (OutlineSegment& segment : loop.segments) {
        segment.first = (segment.first - start + n) % n;
        segment.last = (segment.last - start + n) % n;
    }
    std::stable_sort(loop.segments.begin(), loop.segments.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    return loop;
}

}  // namespace

Outline trace_outline(const Region& region, const Chart& chart) {
    Outline outline{trace_loop(region, region.border, chart), {}};
    for (const auto& hole : region.holes) outline.holes.push_back(trace_loop(region, hole, chart));
    return outline;
}

}  // namespace lastflat
