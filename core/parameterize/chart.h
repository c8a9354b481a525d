// A region laid into the plane.
#pragma once

#include "core/cut/region.h"

namespace lastflat {

/// One 2D point per region vertex, mm; triangles keep their orientation (counter-clockwise).
struct Chart {
    Points2 uv;
};

/// Triangles that are not counter-clockwise in the plane, ascending.
[[nodiscard]] std::vector<Index> flipped_triangles(const Region& region, const Points2& uv);

/// The first of these triangles (a thousand at most), by the file's vertex ids: for errors.
[[nodiscard]] std::vector<Triangle> source_triangles(const Region& region,
                                                     const std::vector<Index>& triangles);

/// The border loop in the plane, in its order.
[[nodiscard]] Points2 flat_border(const Region& region, const Points2& uv);

/// Flat area, mm^2, triangles counted with their sign.
[[nodiscard]] double flat_area(const Region& region, const Points2& uv);

}  // namespace lastflat
