// Where a curve has two sides that will be sewn together.
#pragma once

#include <string_view>

#include "core/cut/region.h"

namespace lastflat {

/// The same stretch of a curve once from each side, as vertices of the regions there, which may be
/// one region: of a slit, or of a seam that opens a ring. Both in the curve's direction.
struct SeamStretch {
    struct Side {
        std::size_t region;
        std::vector<Index> vertices;
    };
    Side a, b;
};

/// The longest stretches along which one run of the curve lies on either side, in the order of the
/// runs.
[[nodiscard]] std::vector<SeamStretch> seam_stretches(const std::vector<const Region*>& regions,
                                                      std::string_view curve);

}  // namespace lastflat
