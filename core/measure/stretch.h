// How one triangle was stretched, from its corners alone.
#pragma once

#include "core/cut/region.h"

namespace lastflat {

/// Singular values G >= g of the map plane -> surface, and both areas.
struct Stretch {
    double G, g, area_3d, area_2d;
};

/// Paper: [sander-2001], section 3.
[[nodiscard]] Stretch stretch_of(const Region& region, const Points2& uv, const Triangle& t);

}  // namespace lastflat
