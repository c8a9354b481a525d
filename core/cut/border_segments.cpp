#include "core/cut/border_segments.h"

namespace lastflat {

std::vector<BorderSegment> border_segments(const Region& region, const std::vector<Index>& loop) {
    const auto n = static_cast<Index>(loop.size());
    std::vector<Index> place_of(region.positions.size(), -1);
    for (Index i = 0; i < n; ++i) {
        place_of[static_cast<std::size_t>(loop[static_cast<std::size_t>(i)])] = i;
    }
    std::vector<BorderSegment> segments;
    for (const CurveRun& run : region.runs) {
        const auto place = [&](std::size_t k) {
            return place_of[static_cast<std::size_t>(run.vertices[k])];
        };
        bool forward = true, backward = true;
        for (std::size_t k = 1; k < run.vertices.size(); ++k) {
            const bool on_loop = place(k - 1) >= 0 && place(k) >= 0;
            forward = forward && on_loop && (place(k - 1) + 1) % n == place(k);
            backward = backward && on_loop && (place(k) + 1) % n == place(k - 1);
        }
        const std::size_t end = run.vertices.size() - 1;
        if (forward)
            segments.push_back({run.curve, place(0), place(end)});
        else if (backward)
            segments.push_back({run.curve, place(end), place(0)});
    }
    return segments;
}

}  // namespace lastflat
