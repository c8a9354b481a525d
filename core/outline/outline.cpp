#include "core/outline/outline.h"

#include <algorithm>

#include "core/cut/border_segments.h"

namespace lastflat {
Outline trace_outline(const Region& region, const Chart& chart) {
    const auto n = static_cast<Index>(region.border.size());
    Outline outline;
    for (const BorderSegment& segment : border_segments(region)) {
        outline.segments.push_back({segment.curve, segment.first, segment.last});
    }
    const Index start = outline.segments.empty() ? 0 : outline.segments.front().first;
    for (Index i = 0; i < n; ++i) {
        const Index v = region.border[static_cast<std::size_t>((start + i) % n)];
        outline.points.push_back(chart.uv[static_cast<std::size_t>(v)]);
    }
    for (OutlineSegment& segment : outline.segments) {
        segment.first = (segment.first - start + n) % n;
        segment.last = (segment.last - start + n) % n;
    }
    std::stable_sort(outline.segments.begin(), outline.segments.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    return outline;
}

}  // namespace lastflat
