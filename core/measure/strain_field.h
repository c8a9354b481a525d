// The strain of the leather when it is lasted, from place to place.
#pragma once

#include "core/cut/region.h"
#include "core/request.h"

namespace lastflat {

/// Per triangle what the shading shows: percent, above 0 stretched, below 0 gathered; of `shear`
/// degrees; of `plain` nothing at all.
[[nodiscard]] std::vector<double> triangle_strains(const Region& region, const Points2& uv,
                                                   Shading shading);

/// Per vertex the mean of its triangles, by their area on the last.
[[nodiscard]] std::vector<double> vertex_means(const Region& region,
                                               const std::vector<double>& of_triangles);

/// The triangle whose strain is the worst of what the shading is looked at for: most stretched,
/// most gathered, or furthest from 0.
[[nodiscard]] std::size_t worst_triangle(const std::vector<double>& strains, Shading shading);

}  // namespace lastflat
