// One piece of the surface, opened flat along its cuts.
#pragma once

#include <string>
#include <vector>

#include "core/numerics/half_edges.h"

namespace lastflat {

/// A stretch of a named curve that lies in one region, as consecutive region vertices that share
/// edges. A cut whose two sides fall into the same region (a slit) gives one run for each side.
struct CurveRun {
    std::string curve;
    std::vector<Index> vertices;
    [[nodiscard]] bool closed() const { return vertices.front() == vertices.back(); }
};

/// A triangulated disk, with holes or without, with ids of its own, in ascending order of the
/// file's ids. Every border loop has the surface on its left, seen from outside.
struct Region : Triangulation {
    std::string name;
    std::vector<Index> border;                ///< the outer loop: counter-clockwise
    std::vector<std::vector<Index>> holes{};  ///< all other loops: clockwise
    std::vector<Index> source_vertices;       ///< per vertex, its id (`SourceIds`)
    std::vector<Index> source_triangles{};    ///< per triangle, `FaceOrigin::triangle`
    std::vector<CurveRun> runs;
    HalfEdges half_edges;

    [[nodiscard]] double distance(Index a, Index b) const {
        return (position(a) - position(b)).norm();
    }
};

/// The outer loop, then the holes.
[[nodiscard]] std::vector<std::vector<Index>> border_loops(const Region& region);

/// Per vertex, whether it is on one of the border loops.
[[nodiscard]] std::vector<bool> border_mask(const Region& region);

/// The 3D length of every edge of a loop; edge i runs from loop[i] to its successor. mm.
[[nodiscard]] std::vector<double> loop_lengths(const Region& region,
                                               const std::vector<Index>& loop);

[[nodiscard]] double loop_length(const Region& region, const std::vector<Index>& loop);

/// Of the outer loop.
[[nodiscard]] std::vector<double> border_lengths(const Region& region);

/// For each of the region's border loops how far its line turns left on the surface: the sum of pi
/// less the surface's angle over its vertices. A full turn around a flat piece, minus a full turn
/// around a hole in it, nothing around the end of a tube. Radians.
[[nodiscard]] std::vector<double> loop_turnings(const Region& region,
                                                const std::vector<std::vector<Index>>& loops);

/// The mean normal times the area, mm^2.
[[nodiscard]] Vec3 area_vector(const Region& region);

/// Surface area, mm^2.
[[nodiscard]] double surface_area(const Region& region);

}  // namespace lastflat
