#include "core/cut/border_segments.h"

namespace lastflat {

std::vector<BorderSegment> border_segments(const Region& region, const std::vector<Index>& loop) {
    const auto n = static_cast<Index>(loop.size());
    const auto index_in_loop = inverse(loop, region.positions.size());
    std::vector<BorderSegment> segments;
    for (const CurveRun& run : region.runs) {
        const auto index = [&](std::size_t k) { return index_in_loop[at(run.vertices[k])]; };
        bool forward = true, backward = true;
        for (std::size_t k = 1; k < run.vertices.size(); ++k) {
            const bool on_loop = index(k - 1) >= 0 && index(k) >= 0;
            forward = forward && on_loop && (index(k - 1) + 1) % n == index(k);
            backward = backward && on_loop && (index(k) + 1) % n == index(k - 1);
        }
        const std::size_t end = run.vertices.size() - 1;
        if (forward)
            segments.push_back({run.curve, index(0), index(end)});
        else if (backward)
            segments.push_back({run.curve, index(end), index(0)});
    }
    return segments;
}

}  // namespace lastflat
