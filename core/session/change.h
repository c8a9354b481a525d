// What of a request a change touches.
#pragma once

#include "core/request.h"

namespace lastflat {

/// How much has to be done anew, the least first; each includes those before it.
enum class Reach {
    nothing,
    curves,   ///< lines that are only shown
    pattern,  ///< what is asked of the same regions
    regions,  ///< where the surface is cut, or what curves it carries
    model     ///< what the surface is
};

/// Whether a curve is only shown: drawn or joined on the surface, not cut along, with nothing asked
/// of it and no name that has a meaning. It need not become edges of the surface.
[[nodiscard]] bool is_shown_only(const Request& request, const CurveSource& curve);

/// The request without the curves that are only shown and the points that only those name; and
/// those curves, with all points.
struct ShownApart {
    Request request;
    std::vector<CurveSource> shown{};
    std::vector<PointSource> points{};
};
[[nodiscard]] ShownApart shown_apart(Request request);

[[nodiscard]] Reach reach_of_change(const ShownApart& from, const ShownApart& to);

}  // namespace lastflat
