#include "core/locate/surface_search.h"

#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

Triangulation triangulation_of(const SurfaceMesh& surface) {
    Triangulation result;
    for (const auto v : surface.mesh.vertices())
        result.positions.push_back(surface.position(v.idx()));
    for (const auto face : surface.mesh.faces())
        result.triangles.push_back(corners_of(surface, face.idx()));
    return result;
}

}  // namespace

SurfaceSearch::SurfaceSearch(const SurfaceMesh& surface)
    : surface_(surface), search_(triangulation_of(surface)) {}

SurfaceSearch::Nearest SurfaceSearch::nearest(const Vec3& position) const {
    const auto found = search_.nearest(position);
    Vec3 weights = (found.weights.array() < tolerance::on_edge).select(0.0, found.weights);
    weights /= weights.sum();
    return {{corners_of(surface_, found.triangle), weights}, found.position, found.distance};
}

}  // namespace lastflat
