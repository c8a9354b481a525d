#include "core/locate/border_loop.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/locate/curve_error.h"
#include "core/numerics/geometry.h"
#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

using HalfedgeHandle = OpenMesh::HalfedgeHandle;

[[noreturn]] void fail_border_at(const std::string& curve, const std::string& what,
                                 const std::optional<Vec3>& position = std::nullopt) {
    fail_curve(curve, "border_at", std::nullopt, what, position);
}

double size_of(const SurfaceMesh& surface) {
    Eigen::AlignedBox3d box;
    for (const auto v : surface.mesh.vertices()) {
        if (!surface.mesh.is_isolated(v)) box.extend(surface.position(v.idx()));
    }
    return box.diagonal().norm();
}

/// The side of a border edge where there is no face, nearest to the position.
HalfedgeHandle nearest_side(const SurfaceMesh& surface, const std::string& curve,
                            const Vec3& position) {
    HalfedgeHandle best;
    double least = std::numeric_limits<double>::infinity();
    for (const auto side : surface.mesh.halfedges()) {
        if (!surface.mesh.is_boundary(side)) continue;
        const Vec3 from = surface.position(surface.mesh.from_vertex_handle(side).idx());
        const Vec3 to = surface.position(surface.mesh.to_vertex_handle(side).idx());
        const Vec3 nearest = from + nearest_share(from, to, position) * (to - from);
        const double distance = (nearest - position).norm();
        if (distance >= least) continue;
        least = distance;
        best = side;
    }
    if (!best.is_valid())
        fail_border_at(curve, "the surface is closed and has no border", position);
    if (least > tolerance::border_reach * size_of(surface))
        fail_border_at(curve,
                       "the place is " + std::to_string(std::lround(least)) +
                           " mm away from the nearest border; are the units right?",
                       position);
    return best;
}

HalfedgeHandle side_at(const SurfaceMesh& surface, const std::string& curve, Index id) {
    if (!surface.is_on_surface(id))
        fail_border_at(curve, "vertex " + std::to_string(id) + " is not on the selected faces");
    const OpenMesh::VertexHandle vertex(surface.welded_to[static_cast<std::size_t>(id)]);
    for (const auto side : surface.mesh.voh_range(vertex)) {
        if (surface.mesh.is_boundary(side)) return side;
    }
    fail_border_at(curve, "vertex " + std::to_string(id) + " is not on the border");
}

}  // namespace

std::vector<Index> border_loop(const SurfaceMesh& surface, const std::string& curve,
                               const BorderAt& border) {
    const auto* vertex = std::get_if<Index>(&border.location);
    const HalfedgeHandle start =
        vertex != nullptr ? side_at(surface, curve, *vertex)
                          : nearest_side(surface, curve, std::get<Vec3>(border.location));
    std::vector<Index> loop;
    HalfedgeHandle side = start;
    do {
        loop.push_back(surface.mesh.from_vertex_handle(side).idx());
        side = surface.mesh.next_halfedge_handle(side);
    } while (side != start);
    std::reverse(loop.begin(), loop.end());
    std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
    loop.push_back(loop.front());
    return loop;
}

}  // namespace lastflat
