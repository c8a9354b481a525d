#include "core/cut/source_ids.h"

namespace lastflat {

SourceIds::SourceIds(const SurfaceMesh& surface, std::vector<SurfacePoint> added_by_curves)
    : vertices(surface.welded_to.size() - surface.copies.size()),
      triangles(surface.file_triangles),
      copies(surface.copies),
      added(std::move(added_by_curves)) {
    for (std::size_t v = 0; v < vertices; ++v) welded_to.push_back(of_file(surface.welded_to[v]));
}

std::optional<Index> SourceIds::file_vertex(Index id) const {
    if (at(id) >= vertices + copies.size()) return std::nullopt;
    return of_file(id);
}

SurfacePoint SourceIds::made_at(Index id) const {
    SurfacePoint made = added[at(id) - vertices - copies.size()];
    for (Index& corner : made.corners) {
        if (corner >= 0) corner = of_file(corner);
    }
    return made;
}

}  // namespace lastflat
