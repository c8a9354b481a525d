#include "core/outline/outline.h"

#include <algorithm>

namespace lastflat {
namespace {

/// Where a run lies on the border, in border order; nothing if it does not follow the border.
std::vector<OutlineSegment> border_segments(const Region& region) {
    const auto n = static_cast<Index>(region.border.size());
    std::vector<Index> place_of(region.positions.size(), -1);
    for (Index i = 0; i < n; ++i) {
        place_of[static_cast<std::size_t>(region.border[static_cast<std::size_t>(i)])] = i;
    }
    std::vector<OutlineSegment> segments;
    for (const CurveRun& run : region.runs) {
        const auto place = [&](std::size_t k) {
            return place_of[static_cast<std::size_t>(run.vertices[k])];
        };
        bool forward = true, backward = true;
        for (std::size_t k = 1; k < run.vertices.size(); ++k) {
            const bool on_border = place(k - 1) >= 0 && place(k) >= 0;
            forward = forward && on_border && (place(k - 1) + 1) % n == place(k);
            backward = backward && on_border && (place(k) + 1) % n == place(k - 1);
        }
        const std::size_t end = run.vertices.size() - 1;
        if (forward) segments.push_back({run.curve, place(0), place(end)});
        else if (backward) segments.push_back({run.curve, place(end), place(0)});
    }
    return segments;
}

}  // namespace

Outline trace_outline(const Region& region, const Chart& chart) {
    const auto n = static_cast<Index>(region.border.size());
    Outline outline;
    outline.segments = border_segments(region);
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
