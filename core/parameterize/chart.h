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

/// A loop in the plane, in its order.
[[nodiscard]] Points2 flat_loop(const std::vector<Index>& loop, const Points2& uv);

/// Where a border loop crosses itself in the plane, or has its sides over each other: two points on
/// the last.
struct BorderCrossing {
    Vec3 a, b;
};

/// All crossings of the outer loop and of every hole, each with itself (see `BorderContact`), and
/// every loop that crosses nowhere but runs around the other way than it must: a slit whose sides
/// have changed places.
[[nodiscard]] std::vector<BorderCrossing> border_crossings(const Region& region, const Points2& uv);

/// Flat area, mm^2, triangles counted with their sign.
[[nodiscard]] double flat_area(const Region& region, const Points2& uv);

}  // namespace lastflat
