// Exact distances along the triangulated surface.
#pragma once

#include <vector>

#include "core/geodesic/unfolding.h"
#include "core/progress.h"

namespace lastflat {

/// Distances from one vertex to every other, mm, and how each shortest path arrives.
struct GeodesicDistances {
    /// The last straight stretch of a shortest path. It comes from `root`, the vertex where the
    /// path bent last (or the source), which lies at `position` in the frame of `half_edge`, across
    /// which it enters the last triangle. `half_edge` -1: it runs along the edge from `root`.
    struct Arrival {
        Index root, half_edge;
        Vec2 position;
    };

    Index source = -1;
    std::vector<double> distance;
    std::vector<Arrival> arrivals;
};

/// Exact polyhedral geodesic distances on one triangulated surface, by windows that are propagated
/// across edges.
///
/// Paper:  [chen-1990] (windows, one angle one split), [xin-2009] (filtering against the vertices'
///         distances), order of work by buckets as in [xu-2015]. Unlike them: a shortest path may
///         also bend around border vertices, and windows that a bend opens are clipped to the
///         directions in which a shortest path can go on.
///         Windows whose ends coincide but for round-off are joined at the vertex between them, so
///         that symmetric shapes, flat parts and rows of vertices in line leave no gaps.
/// Guarantees: round-off apart, the length of the shortest path on the triangles; in any case no
///         more than along the edges. Time and memory depend on the number of windows, about n^1.5
///         on a smooth surface of n triangles.
class ExactGeodesics {
public:
    /// `windows_per_half_edge`: how many a run may make on average; smooth surfaces of a million
    /// triangles take 200, malicious ones any number.
    explicit ExactGeodesics(const Triangulation& surface, std::size_t windows_per_half_edge = 500);
    explicit ExactGeodesics(Unfolding unfolding, std::size_t windows_per_half_edge = 500);

    /// Out:    infinite distances on pieces that do not hang together with the vertex.
    /// Throws: Error{canceled}; Error{solver_failed} if a run would make too many windows.
    [[nodiscard]] GeodesicDistances from_vertex(Index vertex, const Progress& progress) const;

    [[nodiscard]] const Unfolding& unfolding() const { return unfolding_; }

private:
    Unfolding unfolding_;
    std::size_t most_windows_;
    std::vector<double> total_angles_;  ///< per vertex where paths may bend; 0: they cannot
};

}  // namespace lastflat
