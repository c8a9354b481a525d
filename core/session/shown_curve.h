// A curve that is only shown, on the last and on the pattern.
#pragma once

#include "core/locate/curves.h"
#include "core/map/pattern_map.h"

namespace lastflat {

/// The part of a curve that lies on one piece.
struct ShownRun {
    std::string region;
    Points2 uv;  ///< mm
};

struct ShownCurve {
    std::string name;
    Points3 on_last;             ///< where it runs, from one edge of the surface to the next, mm
    std::vector<ShownRun> runs;  ///< in its order; where it crosses a cut, another begins
    double length_3d = 0.0, length_2d = 0.0;  ///< mm; flat: of its runs
};

/// `surface`: the one on which the line was located.
[[nodiscard]] ShownCurve shown_curve(const SurfaceMesh& surface, const SurfaceLine& line,
                                     const PatternMap& map);

}  // namespace lastflat
