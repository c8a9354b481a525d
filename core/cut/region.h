// One piece of the surface, opened flat along its cuts.
#pragma once

#include <string>
#include <vector>

#include "core/numerics/types.h"

namespace lastflat {

/// A stretch of a named curve that lies in one region, as consecutive region vertices that share
/// edges. A cut whose two sides fall into the same region (a slit) gives one run for each side.
struct CurveRun {
    std::string curve;
    std::vector<Index> vertices;
    [[nodiscard]] bool closed() const { return vertices.front() == vertices.back(); }
};

/// A triangulated disk with ids of its own, in ascending order of the file's ids.
struct Region : Triangulation {
    std::string name;
    std::vector<Index> border;           ///< the border loop, counter-clockwise seen from outside
    std::vector<Index> source_vertices;  ///< per vertex, its id in the file
    std::vector<CurveRun> runs;

    [[nodiscard]] double distance(Index a, Index b) const {
        return (position(a) - position(b)).norm();
    }
};

/// Per vertex, whether it is on the border.
[[nodiscard]] std::vector<bool> border_mask(const Region& region);

/// The 3D length of every border edge; edge i runs from border[i] to its successor. mm.
[[nodiscard]] std::vector<double> border_lengths(const Region& region);

/// The mean normal times the area, mm^2.
[[nodiscard]] Vec3 area_vector(const Region& region);

/// Surface area, mm^2.
[[nodiscard]] double surface_area(const Region& region);

}  // namespace lastflat
