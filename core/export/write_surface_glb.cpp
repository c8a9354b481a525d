#include "core/export/write_surface_glb.h"

#include "core/export/glb_container.h"
#include "core/locate/surface_point.h"

namespace lastflat {

std::string write_surface_glb(const SurfaceMesh& surface) {
    constexpr double metre = 1000.0;  // mm
    Points3 positions;
    for (const auto vertex : surface.mesh.vertices())
        positions.push_back(surface.position(vertex.idx()) / metre);
    std::vector<Triangle> triangles;
    for (const auto face : surface.mesh.faces())
        triangles.push_back(corners_of(surface, face.idx()));
    GlbContainer glb;
    nlohmann::ordered_json& document = glb.document();
    const std::size_t place = glb.add_positions(positions), corners = glb.add_indices(triangles);
    document["meshes"].push_back(
        {{"name", "surface"},
         {"primitives", {{{"attributes", {{"POSITION", place}}}, {"indices", corners}}}},
         {"extras", {{"welded_to", glb.add_ids(surface.welded_to)}}}});
    document["nodes"].push_back({{"name", "surface"}, {"mesh", 0}});
    document["scenes"].push_back({{"nodes", {0}}});
    return glb.write();
}

}  // namespace lastflat
