// What CGAL makes of a region: an oracle for the tests, a peer for the benchmarks.
#pragma once

#include <memory>

#include "core/cut/region.h"

namespace lastflat::peers {

/// A region as CGAL's mesh, built once.
class CgalMesh {
public:
    explicit CgalMesh(const Region& region);
    ~CgalMesh();
    CgalMesh(const CgalMesh&) = delete;
    CgalMesh& operator=(const CgalMesh&) = delete;

    // Each returns one point per vertex of the region; throws std::runtime_error with CGAL's words.
    // `border`: a place for each border vertex, in the order of the region's border.
    [[nodiscard]] Points2 tutte(const Points2& border);
    [[nodiscard]] Points2 mean_value(const Points2& border);
    [[nodiscard]] Points2 harmonic(const Points2& border);
    [[nodiscard]] Points2 lscm();
    [[nodiscard]] Points2 arap(double lambda);

    /// Exact geodesic distances from a vertex to all.
    [[nodiscard]] std::vector<double> distances_from(Index vertex);

private:
    struct Mesh;
    std::unique_ptr<Mesh> mesh_;
};

}  // namespace lastflat::peers
