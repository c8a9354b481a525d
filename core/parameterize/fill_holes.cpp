#include "core/parameterize/fill_holes.h"

#include <numbers>

#include "core/numerics/geometry.h"

namespace lastflat {
namespace {

/// A cone is raised by this share of the radius of a circle as long as the hole.
constexpr double raised = 0.1;

/// Per vertex, the normals of its triangles by their areas.
std::vector<Vec3> vertex_normals(const Region& region) {
    std::vector<Vec3> normals(region.positions.size(), Vec3::Zero());
    for (const Triangle& t : region.triangles) {
        const Vec3 normal = doubled_area_vector(region, t);
        for (const Index v : t) normals[static_cast<std::size_t>(v)] += normal;
    }
    return normals;
}

}  // namespace

Region with_holes_filled(const Region& region) {
    Region filled = region;
    filled.runs.clear();
    filled.holes.clear();
    const auto normals = vertex_normals(region);
    for (const auto& hole : region.holes) {
        Vec3 centre = Vec3::Zero(), normal = Vec3::Zero();
        for (const Index v : hole) {
            centre += region.position(v) / static_cast<double>(hole.size());
            normal += normals[static_cast<std::size_t>(v)];
        }
        const double height = raised * loop_length(region, hole) / (2.0 * std::numbers::pi);
        const auto apex = static_cast<Index>(filled.positions.size());
        filled.positions.emplace_back(centre + height * normal.normalized());
        filled.source_vertices.push_back(-1);
        for (std::size_t i = 0; i < hole.size(); ++i)
            filled.triangles.push_back({hole[(i + 1) % hole.size()], hole[i], apex});
    }
    if (!region.holes.empty()) filled.half_edges = HalfEdges(filled);
    return filled;
}

}  // namespace lastflat
